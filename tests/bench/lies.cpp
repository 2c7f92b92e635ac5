#include "bench/lies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace haustra::bench {

using protocol::ServerMessage;

std::uint64_t pick(Random& random, std::uint64_t most) {
    return std::uniform_int_distribution<std::uint64_t>(0, most)(random);
}

bool chance(Random& random, double share) {
    return std::uniform_real_distribution<double>(0.0, 1.0)(random) < share;
}

double wildNumber(Random& random) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    const std::array wild{std::nan(""), inf,    -inf,   1.7e308, -1.7e308, 1e200, -1e200, 1e40,
                          -1e40,        5e-324, 1e-200, 0.0,     -0.0,     -1.0,  1e6,    -1e6,
                          1e9,          -1e9,   2.2e9,  9.3e18,  -9.3e18,  1e-9,  0.5,    1e5};
    if (chance(random, 0.2)) return std::uniform_real_distribution<double>(-1e4, 1e4)(random);
    return wild[pick(random, wild.size() - 1)];
}

std::string wildText(Random& random, std::size_t mostBytes) {
    const auto repeated = [&](const std::string& part) {
        constexpr std::array counts{1u, 3u, 40u, 2000u, 100'000u, 3'000'000u};
        const std::size_t times =
            std::min<std::size_t>(counts[pick(random, counts.size() - 1)], mostBytes / part.size());
        std::string all;
        for (std::size_t n = 0; n < times; ++n)
            all += part;
        return all;
    };
    switch (pick(random, 11)) {
        case 0:
            return {};
        case 1:
            return repeated("x");
        case 2:
            return repeated("word and ");
        case 3:
            return repeated("\n");
        case 4:
            return repeated("line\r\n\t");
        case 5:
            return repeated("<b>bold</b><img src=\"file:///etc/passwd\" width=90000 height=90000>");
        case 6:
            return "<table width=100000>" + repeated("<tr><td><table><tr><td>") + "</table>";
        case 7:
            return repeated("\u202Eright to left \u05D0\u05D1\u202D");
        case 8:
            return repeated("e\u0301\u0302\u0303\u0304\u0305\u0306\u0307\u0308");
        case 9:
            return repeated(std::string("\0\1\2\x1b[31m\x7f\b", 10));
        case 10:
            return repeated("&File\tCtrl+Q %1 %n %s ../../");
        default:
            return repeated("\U0001F468\u200D\U0001F469\u200D\U0001F467\uFFFF\u2028");
    }
}

void mutateBytes(Random& random, std::vector<std::uint8_t>& bytes, std::size_t from) {
    if (bytes.size() <= from) return;
    const std::size_t changes = 1 + pick(random, chance(random, 0.5) ? 3 : 40);
    for (std::size_t n = 0; n < changes; ++n) {
        std::uint8_t& byte = bytes[from + pick(random, bytes.size() - from - 1)];
        if (chance(random, 0.5))
            byte = std::uint8_t(random());
        else
            byte ^= std::uint8_t(1u << pick(random, 7));
    }
}

namespace {

std::uint32_t wildCount(Random& random) {
    constexpr std::array wild{0u, 1u, 2u, 255u, 4096u, 4097u, 65536u, 0x7fffffffu, 0xffffffffu};
    return wild[pick(random, wild.size() - 1)];
}

void fillWild(Random& random, protocol::Vec3& v) {
    v.set_x(wildNumber(random));
    v.set_y(wildNumber(random));
    v.set_z(wildNumber(random));
}

/// `samples` of a path that grows along z, at `step` from each to the next.
void fillPath(protocol::CaseOpened& opened, std::size_t samples, double step) {
    opened.clear_centerline();
    opened.clear_gap_samples();
    for (std::size_t n = 0; n < samples; ++n)
        for (const double number : {10.0, 20.0, step * double(n), step * double(n), 12.0})
            opened.add_centerline(number);
}

using Opened = protocol::CaseOpened;
template <class Change>
Lie ofCase(const char* name, Change change) {
    return {
        std::string("case: ") + name, ServerMessage::kCaseOpened,
        [change](Random& random, ServerMessage& m) { change(random, *m.mutable_case_opened()); }};
}

void addPresets(Random& random, Opened& opened, std::size_t count) {
    const protocol::OpticsPreset first = opened.presets(0);
    for (std::size_t n = 0; n < count; ++n) {
        auto* preset = opened.add_presets();
        *preset = first;
        preset->set_name("p" + std::to_string(chance(random, 0.1) ? 0 : n));
    }
}

void addCaseLies(std::vector<Lie>& all) {
    const auto add = [&](const char* name, auto change) { all.push_back(ofCase(name, change)); };
    add("another than asked for", [](Random&, Opened& o) { o.set_name("another"); });
    add("wild name", [](Random& r, Opened& o) { o.set_name(wildText(r)); });
    add("wild scan", [](Random& r, Opened& o) { o.set_scan(wildText(r)); });
    add("another scan", [](Random& r, Opened& o) { o.set_scan(std::to_string(r())); });
    add("wild size", [](Random& r, Opened& o) {
        o.set_size_x(wildCount(r));
        if (chance(r, 0.5)) o.set_size_y(wildCount(r));
        if (chance(r, 0.5)) o.set_size_z(wildCount(r));
    });
    add("smallest scan",
        [](Random&, Opened& o) { o.set_size_x(1), o.set_size_y(1), o.set_size_z(1); });
    add("wild affine", [](Random& r, Opened& o) {
        for (std::uint64_t n = 0, count = pick(r, 5); n <= count; ++n)
            o.set_patient_from_voxel(int(pick(r, 11)), wildNumber(r));
    });
    add("scaled affine", [](Random& r, Opened& o) {
        constexpr std::array scales{0.0, 1e-300, 1e-12, 1e-4, 1e4, 1e12, 1e150, 1e300};
        const double scale = scales[pick(r, scales.size() - 1)];
        for (double& number : *o.mutable_patient_from_voxel())
            number *= scale;
    });
    add("too few numbers",
        [](Random& r, Opened& o) { o.mutable_patient_from_voxel()->Truncate(int(pick(r, 11))); });
    add("no path", [](Random&, Opened& o) { o.clear_centerline(), o.clear_gap_samples(); });
    add("path of one", [](Random&, Opened& o) { fillPath(o, 1, 1.0); });
    add("path of two", [](Random&, Opened& o) { fillPath(o, 2, 1.0); });
    add("long path", [](Random& r, Opened& o) {
        fillPath(o, 90'000, 0.01);
        for (std::uint32_t n = 1; n < 90'000; n += 2)
            if (chance(r, 0.9)) o.add_gap_samples(n);
    });
    add("endless path", [](Random&, Opened& o) { fillPath(o, 1'000'000, 0.001); });
    add("path of equal points", [](Random&, Opened& o) {
        fillPath(o, 20'000, 0.0);
        for (std::uint32_t n = 1; n < 20'000; n += 2)
            o.add_gap_samples(n);
    });
    add("huge path", [](Random& r, Opened& o) {
        constexpr std::array steps{1e3, 1e7, 1e100, 1e302};
        fillPath(o, 1000, steps[pick(r, 3)]);
    });
    add("wild path", [](Random& r, Opened& o) {
        for (std::uint64_t n = 0, count = pick(r, 20); n <= count; ++n)
            o.set_centerline(int(pick(r, std::uint64_t(o.centerline_size() - 1))), wildNumber(r));
    });
    add("wild radii", [](Random& r, Opened& o) {
        for (int n = 4; n < o.centerline_size(); n += 5)
            o.set_centerline(n, wildNumber(r));
    });
    add("wild gaps", [](Random& r, Opened& o) {
        for (int n = 0; n < 100; ++n)
            o.add_gap_samples(chance(r, 0.05) ? wildCount(r) : std::uint32_t(pick(r, 300)));
    });
    add("wild position", [](Random& r, Opened& o) { o.set_patient_position(wildText(r)); });
    add("no presets", [](Random&, Opened& o) { o.clear_presets(); });
    add("many presets", [](Random& r, Opened& o) { addPresets(r, o, 1000); });
    add("endless presets", [](Random& r, Opened& o) { addPresets(r, o, 25'000); });
    add("wild preset", [](Random& r, Opened& o) {
        auto* preset = o.mutable_presets(int(pick(r, std::uint64_t(o.presets_size() - 1))));
        if (chance(r, 0.2)) preset->set_name(wildText(r));
        if (chance(r, 0.4)) preset->set_description(wildText(r));
        auto* optics = preset->mutable_optics();
        if (chance(r, 0.2)) optics->clear_points();
        for (std::uint64_t n = pick(r, 3); n > 0; --n) {
            auto* point = optics->add_points();
            point->set_hu(wildNumber(r)), point->set_red(wildNumber(r));
            point->set_opacity(wildNumber(r));
        }
        for (std::uint64_t n = pick(r, 3) * pick(r, 30); n > 0; --n) {
            auto* row = optics->add_rows();
            row->set_gradient_hu_per_mm(chance(r, 0.5) ? 100.0 * double(90 - n) : wildNumber(r));
            *row->mutable_points() = optics->points();
        }
        if (chance(r, 0.3)) optics->set_composition(protocol::Composition(wildCount(r)));
        if (chance(r, 0.3)) optics->mutable_light()->set_half_depth_mm(wildNumber(r));
        if (chance(r, 0.3)) optics->mutable_light()->set_shininess(wildNumber(r));
    });
    add("histogram of many bins", [](Random& r, Opened& o) {
        o.mutable_histogram()->set_first_hu(-1024.0);
        o.mutable_histogram()->set_hu_per_bin(chance(r, 0.5) ? 0.06 : wildNumber(r));
        for (std::uint64_t n = 0, count = chance(r, 0.5) ? 65'536 : 400'000; n < count; ++n)
            o.mutable_histogram()->add_voxels(r());
    });
    add("wild histogram", [](Random& r, Opened& o) {
        o.mutable_histogram()->set_first_hu(wildNumber(r));
        o.mutable_histogram()->set_hu_per_bin(wildNumber(r));
        for (std::uint64_t n = pick(r, 300); n > 0; --n)
            o.mutable_histogram()->add_voxels(chance(r, 0.5) ? ~std::uint64_t(0) : pick(r, 9));
    });
    add("no strip", [](Random&, Opened& o) { o.clear_flat(); });
    add("wild strip", [](Random& r, Opened& o) {
        if (chance(r, 0.5)) o.mutable_flat()->set_height(wildNumber(r));
        if (chance(r, 0.5)) o.mutable_flat()->set_circumference_mm(wildNumber(r));
        for (std::uint64_t n = pick(r, 3); n > 0 && o.flat().rows_size() > 0; --n)
            o.mutable_flat()->set_rows(int(pick(r, std::uint64_t(o.flat().rows_size() - 1))),
                                       wildNumber(r));
    });
    add("tallest strip", [](Random& r, Opened& o) {
        o.mutable_flat()->set_height(4096.0);
        o.mutable_flat()->set_circumference_mm(chance(r, 0.5) ? 1e-300 : 1e300);
    });
    add("lowest strip", [](Random& r, Opened& o) {
        o.mutable_flat()->set_height(chance(r, 0.5) ? 5e-324 : 1e-6);
        o.mutable_flat()->clear_rows();
        for (int n = 0; n < 4; ++n)
            o.mutable_flat()->add_rows(0.0);
    });
    add("strip of many rows", [](Random&, Opened& o) {
        o.mutable_flat()->clear_rows();
        for (int n = 0; n < 100'000; ++n)
            o.mutable_flat()->add_rows(1.0), o.mutable_flat()->add_rows(1.0);
    });
    add("wild raycaster", [](Random& r, Opened& o) {
        o.set_raycaster(wildText(r, 100'000));
        for (std::uint64_t n = pick(r, 3) * pick(r, 10'000); n > 0; --n) {
            auto* trial = o.add_trials();
            trial->set_raycaster("native"), trial->set_median_ms(wildNumber(r));
            if (chance(r, 0.01)) trial->set_failure(wildText(r, 1000));
        }
    });
    add("many warnings", [](Random& r, Opened& o) {
        auto* trust = o.mutable_trust();
        trust->set_confidence(0.9), trust->set_length_mm(1500.0);
        for (int n = 0; n < 6; ++n)
            trust->add_segments()->set_length_mm(250.0);
        for (std::uint64_t n = chance(r, 0.5) ? 200 : 30'000; n > 0; --n)
            trust->add_warnings(wildText(r, chance(r, 0.02) ? 2000 : 400));
    });
    add("wild trust", [](Random& r, Opened& o) {
        auto* trust = o.mutable_trust();
        trust->set_confidence(wildNumber(r)), trust->set_length_mm(wildNumber(r));
        for (std::uint64_t n = pick(r, 9); n > 0; --n)
            trust->add_segments()->set_gas_ml(wildNumber(r));
    });
}

void addListLies(std::vector<Lie>& all) {
    const auto add = [&](const char* name, auto change) {
        all.push_back({std::string("list: ") + name, ServerMessage::kCaseList,
                       [change](Random& random, ServerMessage& m) {
                           change(random, *m.mutable_case_list());
                       }});
    };
    using List = protocol::CaseList;
    add("100000 cases", [](Random& r, List& l) {
        for (int n = 0; n < 100'000; ++n)
            l.add_names("case-" + std::to_string(n));
        for (int n = 0; chance(r, 0.5) && n < 60'000; ++n) {
            auto* entry = l.add_entries();
            entry->set_name("case-" + std::to_string(n));
            entry->set_state(protocol::CaseEntry::DAMAGED);
            entry->set_reason("why");
        }
    });
    add("2000000 names of nothing", [](Random&, List& l) {
        for (int n = 0; n < 2'000'000; ++n)
            l.add_names("");
    });
    add("the same again", [](Random&, List& l) {
        for (int n = 0; n < 1000; ++n)
            l.add_names("phantom");
    });
    add("wild names", [](Random& r, List& l) {
        for (int n = 0; n < 20; ++n)
            l.add_names(wildText(r, 100'000));
    });
    add("wild entries", [](Random& r, List& l) {
        for (const char* name : {"a", "b", "c", "phantom"}) {
            l.add_names(name);
            auto* entry = l.add_entries();
            entry->set_name(name);
            entry->set_state(protocol::CaseEntry::State(wildCount(r)));
            entry->set_reason(wildText(r)), entry->set_prepared_utc(wildText(r, 10'000));
            entry->set_size_z(wildCount(r)), entry->set_confidence(wildNumber(r));
            fillWild(r, *entry->mutable_spacing_mm());
            entry->set_warnings(wildCount(r)), entry->set_bookmarks(wildCount(r));
            entry->set_readers(wildCount(r));
        }
    });
    add("wild request", [](Random& r, List& l) { l.set_request(r()); });
}

void addBookmarkLies(std::vector<Lie>& all) {
    const auto fill = [](Random& r, protocol::Bookmark& b, std::uint64_t id, bool wild) {
        b.set_id(id);
        b.set_client_key(std::to_string(id));
        b.mutable_forward()->set_z(1.0), b.mutable_up()->set_y(-1.0);
        b.set_arc_mm(double(id % 900));
        b.mutable_position_mm()->set_z(double(id % 100));
        if (!wild) return;
        if (chance(r, 0.4)) fillWild(r, *b.mutable_position_mm());
        if (chance(r, 0.4)) fillWild(r, *b.mutable_forward());
        if (chance(r, 0.4)) fillWild(r, *b.mutable_up());
        if (chance(r, 0.3)) b.clear_forward();
        if (chance(r, 0.4)) b.set_arc_mm(wildNumber(r));
        if (chance(r, 0.5)) b.set_note(wildText(r));
        if (chance(r, 0.3)) b.set_created_utc(wildText(r, 10'000));
        if (chance(r, 0.3)) b.set_client_key(wildText(r, 10'000));
        if (chance(r, 0.2)) b.set_id(r() % 3);
    };
    const auto list = [&](const char* name, auto change) {
        all.push_back({std::string("bookmarks: ") + name, ServerMessage::kBookmarkList,
                       [change](Random& random, ServerMessage& m) {
                           change(random, *m.mutable_bookmark_list());
                       }});
    };
    using List = protocol::BookmarkList;
    list("15000", [fill](Random& r, List& l) {
        for (std::uint64_t n = 1; n <= 15'000; ++n)
            fill(r, *l.add_bookmarks(), n, false);
    });
    list("100000", [](Random& r, List& l) {
        for (std::uint64_t n = 1; n <= 100'000; ++n) {
            l.add_bookmarks()->set_id(n);
            if (chance(r, 0.1)) l.mutable_bookmarks(int(n - 1))->mutable_forward()->set_x(1.0);
        }
    });
    list("2000000 of nothing", [](Random&, List& l) {
        for (int n = 0; n < 2'000'000; ++n)
            l.add_bookmarks();
    });
    for (int times = 0; times < 2; ++times)
        list("wild", [fill](Random& r, List& l) {
            for (std::uint64_t n = 1; n <= 20; ++n)
                fill(r, *l.add_bookmarks(), n, chance(r, 0.3));
        });
    all.push_back({"bookmarks: added unasked", ServerMessage::kBookmarkAdded,
                   [fill](Random& r, ServerMessage& m) {
                       fill(r, *m.mutable_bookmark_added()->mutable_bookmark(), r(),
                            chance(r, 0.5));
                   }});
}

void addAnswerLies(std::vector<Lie>& all) {
    const auto add = [&](const char* name, ServerMessage::BodyCase of, auto change) {
        all.push_back({std::string("answer: ") + name, of, change});
    };
    add("wild place", ServerMessage::kWallPlace, [](Random& r, ServerMessage& m) {
        auto* place = m.mutable_wall_place();
        if (chance(r, 0.5)) fillWild(r, *place->mutable_position_mm());
        if (chance(r, 0.5)) fillWild(r, *place->mutable_camera_mm());
        if (chance(r, 0.5)) place->set_arc_mm(wildNumber(r));
        if (chance(r, 0.3)) place->mutable_flat()->set_x(wildNumber(r));
        if (chance(r, 0.3)) place->mutable_flat()->set_y(wildNumber(r));
    });
    add("place far away", ServerMessage::kWallPlace, [](Random& r, ServerMessage& m) {
        auto* place = m.mutable_wall_place();
        constexpr std::array far{1e5, 1e6, -1e6, 1e9, 1e30, -1e150, 1e300};
        place->mutable_position_mm()->set_x(far[pick(r, far.size() - 1)]);
        place->set_arc_mm(far[pick(r, far.size() - 1)]);
        place->clear_flat();
    });
    add("wild measure", ServerMessage::kFlatMeasure, [](Random& r, ServerMessage& m) {
        m.mutable_flat_measure()->set_length_mm(wildNumber(r));
        m.mutable_flat_measure()->set_area_mm2(wildNumber(r));
        m.mutable_flat_measure()->set_largest_diameter_mm(wildNumber(r));
    });
    add("wild statistics", ServerMessage::kScanStatistics, [](Random& r, ServerMessage& m) {
        m.mutable_scan_statistics()->set_mean_hu(wildNumber(r));
        m.mutable_scan_statistics()->set_deviation_hu(wildNumber(r));
        m.mutable_scan_statistics()->set_samples(r());
        m.mutable_scan_statistics()->set_area_mm2(wildNumber(r));
    });
    add("wild findings", ServerMessage::kFindingList, [](Random& r, ServerMessage& m) {
        auto* list = m.mutable_finding_list();
        list->set_state(protocol::FindingList::State(pick(r, 7)));
        list->set_operating_point(wildNumber(r));
        list->set_trained_on(wildText(r));
        for (auto& finding : *list->mutable_findings()) {
            if (chance(r, 0.3)) finding.set_number(wildCount(r));
            if (chance(r, 0.3)) finding.set_arc_mm(wildNumber(r));
            if (chance(r, 0.3)) finding.set_diameter_mm(wildNumber(r));
            if (chance(r, 0.3)) finding.mutable_position_mm()->set_x(wildNumber(r));
            if (chance(r, 0.3)) finding.add_voxels(wildCount(r));
            if (chance(r, 0.3)) finding.set_kind(wildText(r));
        }
    });
    add("wild missed patches", ServerMessage::kMissedList, [](Random& r, ServerMessage& m) {
        auto* list = m.mutable_missed_list();
        if (chance(r, 0.3)) list->set_area_mm2(wildNumber(r));
        if (chance(r, 0.3)) list->set_count(wildCount(r));
        for (auto& patch : *list->mutable_patches()) {
            if (chance(r, 0.3)) patch.set_area_mm2(wildNumber(r));
            if (chance(r, 0.3)) patch.mutable_view()->mutable_forward()->set_x(wildNumber(r));
            if (chance(r, 0.3)) patch.mutable_place()->set_arc_mm(wildNumber(r));
        }
    });
    add("wild share", ServerMessage::kWallSeen, [](Random& r, ServerMessage& m) {
        m.mutable_wall_seen()->set_share(wildNumber(r));
        if (chance(r, 0.5)) m.mutable_wall_seen()->set_kept(r());
        if (chance(r, 0.5))
            m.mutable_wall_seen()->mutable_limits()->set_pixels_per_mm(wildNumber(r));
        if (chance(r, 0.5)) m.mutable_wall_seen()->set_request(pick(r, 40));
    });
    add("wild welcome", ServerMessage::kWelcome, [](Random& r, ServerMessage& m) {
        auto* welcome = m.mutable_welcome();
        if (chance(r, 0.3)) welcome->set_protocol_version(wildCount(r));
        welcome->set_software(wildText(r)), welcome->set_renderer(wildText(r));
        for (std::uint64_t n = pick(r, 2) * pick(r, 100'000); n > 0; --n)
            welcome->add_capabilities(std::to_string(n));
    });
    add("none of the request", ServerMessage::kWallPlace, [](Random& r, ServerMessage& m) {
        const std::uint64_t request = pick(r, 60);
        switch (pick(r, 4)) {
            case 0:
                m.mutable_wall_seen()->set_request(request);
                break;
            case 1:
                m.mutable_flat_measure()->set_request(request);
                break;
            case 2:
                m.mutable_scan_statistics()->set_request(request);
                break;
            case 3:
                m.mutable_pong()->set_request(request);
                break;
            default:
                m.mutable_wall_place()->set_request(request);
        }
    });
    add("a refusal", ServerMessage::kError, [](Random& r, ServerMessage& m) {
        auto* error = m.mutable_error();
        error->set_code(protocol::ErrorReport::Code(chance(r, 0.1) ? wildCount(r) : pick(r, 9)));
        error->set_message(chance(r, 0.7) ? wildText(r, chance(r, 0.1) ? 3'900'000 : 5000)
                                          : "this does not go");
        error->set_fatal(chance(r, 0.2));
        error->set_request(pick(r, 40));
    });
    add("an empty message", ServerMessage::kError, [](Random&, ServerMessage& m) { m.Clear(); });
}

}  // namespace

const std::vector<Lie>& lies() {
    static const std::vector<Lie> all = [] {
        std::vector<Lie> made;
        addCaseLies(made);
        addListLies(made);
        addBookmarkLies(made);
        addAnswerLies(made);
        return made;
    }();
    return all;
}

}  // namespace haustra::bench
