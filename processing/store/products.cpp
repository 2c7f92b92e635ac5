#include "store/products.h"

#include <algorithm>
#include <set>

namespace haustra::store {
const Catalogue& catalogue() {
    using namespace product;
    static const std::vector<std::string> volume{".nii.gz", ".nii"};
    static const Catalogue products({
        {.name = ct,
         .stage = "import",
         .content = Content::int16Volume,
         .endings = volume,
         .help = "the scan as it came (int16, HU)",
         .shown = true},
        {.name = source,
         .stage = "import",
         .content = Content::text,
         .endings = {".json"},
         .help = "of a DICOM series: its UIDs, and each slice's with its place, for reports to "
                 "refer to"},
        {.name = segmentation,
         .stage = "segmentation",
         .content = Content::uint8Volume,
         .parents = {ct},
         .endings = volume,
         .help =
             "the lumen as the organ's profile finds it, or as the mask says (uint8: 0 outside, "
             "1 air, 2 tagged, 3 bridge over a collapse, 4 fluid without tagging)"},
        {.name = quality,
         .stage = "segmentation",
         .content = Content::text,
         .parents = {ct},
         .endings = {".json"},
         .help = "of a colon: how sure it is, piece by piece, and where to look",
         .shown = true},
        {.name = mixture,
         .stage = "mixture",
         .content = Content::fractionsVolume,
         .parents = {ct, segmentation},
         .endings = volume,
         .help = "the tissues in each voxel (4-D uint8: air, soft tissue, tagged, in 255ths)"},
        {.name = cleansedLumen,
         .stage = "cleansing",
         .content = Content::uint8Volume,
         .parents = {ct, segmentation, mixture},
         .endings = volume,
         .help = "the lumen once the tagging is taken out (uint8, as segmentation)"},
        {.name = cleansed,
         .stage = "cleansing",
         .content = Content::int16Volume,
         .parents = {ct, segmentation, mixture},
         .endings = volume,
         .help = "the scan with air in the tagging's place (int16, HU)",
         .shown = true},
        // Of an organ that is cleansed from the one, else from the other.
        {.name = lumen,
         .stage = "denoising",
         .content = Content::uint8Volume,
         .parents = {segmentation, cleansedLumen, cleansed},
         .endings = volume,
         .help = "the lumen with the organ's topology: a colon without handles (uint8, as "
                 "segmentation)"},
        {.name = distance,
         .stage = "distance",
         .content = Content::floatVolume,
         .parents = {lumen},
         .endings = volume,
         .help = "the distance to the lumen's boundary, 0 outside (float, mm)"},
        {.name = centerline,
         .stage = "centerline",
         .content = Content::centerline,
         .parents = {quality, lumen, distance},
         .endings = {".csv"},
         .help = "the path through the lumen, from the rectum to the cecum "
                 "(x_mm,y_mm,z_mm,arc_mm,radius_mm,gap in LPS)",
         .shown = true},
        {.name = branches,
         .stage = "centerline",
         .content = Content::centerline,
         .parents = {quality, lumen, distance},
         .endings = {".csv"},
         .help =
             "of an organ that branches: paths as centerline, one after the other, each from an "
             "arc of 0 on"},
        // The wall stands in the scan, cleansed or not, at the HU that the segmentation found.
        {.name = surface,
         .stage = "surface",
         .content = Content::mesh,
         .parents = {ct, segmentation, cleansed, lumen},
         .endings = {".ply", ".obj", ".off", ".stl"},
         .help = "the lumen's closed surface (LPS, mm)",
         .shown = true},
        {.name = flatMap,
         .stage = "flattening",
         .content = Content::flatMap,
         .parents = {centerline, surface},
         .endings = {".obj", ".ply"},
         .help = "of an organ that is a tube: the surface, cut open, on the plane: .obj (vt: flat "
                 "coordinates in circumferences) or .ply (s, t, and of each vertex the camera on "
                 "the centerline that sees it, its index and arc_mm, and of each face whether it "
                 "encloses a bridge)",
         .shown = true},
        {.name = findings,
         .stage = "cad",
         .content = Content::text,
         .parents = {ct, source, segmentation, quality, cleansed, lumen, centerline, surface,
                     flatMap},
         .endings = {".json", ".dcm"},
         .help = "of a colon: places that may be polyps, for a physician to judge, each with its "
                 "size, probability and voxels; .dcm: a Colon CAD SR (of a DICOM series)",
         .shown = true},
        // `haustra coverage` makes it.
        {.name = coverage,
         .content = Content::text,
         .parents = {quality, lumen, distance, centerline, surface, flatMap},
         .endings = {".json", ".ply"},
         .help = "what a simulated colonoscopy has shown of the wall (haustra coverage): .json: "
                 "shares and missed patches; .ply: the surface in triangles of at most 1 mm², each "
                 "with its visibility (0 unseen, 1 partly seen, 2 fully seen, 3 a bridge)"},
        // The next segmentation is made by it, under a key that holds it; until then what it is to
        // change stands.
        {.name = edits,
         .content = Content::text,
         .endings = {".json"},
         .help = "what a person said of a colon: seeds, excludes, cuts and joins"},
        {.name = flatImage,
         .parents = {ct, cleansed, lumen, flatMap},
         .endings = {".png", ".tif", ".tiff", ".exr", ".jpg", ".jpeg"},
         .help = "the whole flattened wall seen from within, the rectum at the bottom, black where "
                 "the surface crosses air and hatched along bridges"},
        {.name = biopsy,
         .parents = {ct, segmentation, quality, cleansed, lumen, centerline, surface, flatMap},
         .endings = {".png", ".tif", ".tiff", ".exr", ".jpg", ".jpeg"},
         .help = "of a colon: what lies beneath the whole wall, as a translucent picture, from the "
                 "rectum on the left to the cecum: blue is fat, green the wall's tissue, red what "
                 "is denser, black next to nothing, as in a thin fold with gas behind it"},
    });
    return products;
}

namespace {

using Names = Catalogue::Names;

bool contains(const Names& names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
}

// The words on lines of at most `width` columns, each after `margin` spaces.
std::string wrapped(const std::string& text, std::size_t margin, std::size_t width) {
    const std::string indent(margin, ' ');
    std::string lines, line;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        const std::string word = text.substr(at, end - at);
        if (!line.empty() && margin + line.size() + 1 + word.size() > width) {
            lines += indent + line + '\n';
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
        at = end + 1;
    }
    return lines + indent + line + '\n';
}

constexpr std::size_t helpColumn = 20, helpWidth = 100;

// "  name   text", the text wrapped beside the name.
std::string entry(const std::string& name, const std::string& text, std::size_t indent) {
    std::string lines = wrapped(text, helpColumn, helpWidth);
    std::string head = std::string(indent, ' ') + name + ' ';
    if (head.size() > helpColumn) return head + '\n' + lines;
    return lines.replace(0, head.size(), head);
}

}  // namespace

const Product* Catalogue::find(std::string_view name) const {
    const auto found = std::ranges::find(products_, name, &Product::name);
    return found == products_.end() ? nullptr : &*found;
}

template <class Condition>
Names Catalogue::namesWhere(Condition condition) const {
    Names names;
    for (const Product& product : products_)
        if (condition(product)) names.push_back(product.name);
    return names;
}

Names Catalogue::stages() const {
    Names names;
    for (const Product& product : products_)
        if (!product.stage.empty() && !contains(names, product.stage))
            names.push_back(product.stage);
    return names;
}

Names Catalogue::madeBy(std::string_view stage) const {
    return namesWhere(
        [&](const Product& product) { return !stage.empty() && product.stage == stage; });
}

Names Catalogue::readBy(std::string_view stage) const {
    std::set<std::string> read;
    for (const std::string& name : madeBy(stage)) {
        const Names& parents = find(name)->parents;
        read.insert(parents.begin(), parents.end());
    }
    return namesWhere([&](const Product& product) { return read.contains(product.name); });
}

// Parents come before what is made from them, so that one way through finds all.
Names Catalogue::sources(std::string_view product) const {
    std::set<std::string, std::less<>> found{std::string(product)};
    for (auto at = products_.rbegin(); at != products_.rend(); ++at)
        if (found.contains(at->name)) found.insert(at->parents.begin(), at->parents.end());
    return namesWhere(
        [&](const Product& other) { return other.name != product && found.contains(other.name); });
}

Names Catalogue::madeFrom(std::string_view product) const {
    std::set<std::string, std::less<>> found{std::string(product)};
    for (const Product& other : products_)
        if (std::ranges::any_of(other.parents,
                                [&](const std::string& name) { return found.contains(name); }))
            found.insert(other.name);
    return namesWhere(
        [&](const Product& other) { return other.name != product && found.contains(other.name); });
}

Names Catalogue::exported() const {
    return namesWhere([](const Product& product) { return !product.endings.empty(); });
}

std::string Catalogue::keptHelp() const {
    std::string text = "Products, by the order in which they are made:\n";
    for (const Product& product : products_)
        if (product.content) text += entry(product.name, product.help, 2);
    return text;
}

std::string Catalogue::exportHelp() const {
    std::string text = "Products, and the files that they are written as:\n";
    for (const std::string& name : exported()) {
        const Product& product = *find(name);
        std::string endings;
        for (const std::string& ending : product.endings)
            endings += (endings.empty() ? "" : " ") + ending;
        text += entry(name, endings, 2) + wrapped(product.help, helpColumn, helpWidth);
    }
    return text;
}

std::string Catalogue::stageHelp() const {
    std::string text = "Stages, in their order, and the products that they make:\n";
    for (const std::string& stage : stages()) {
        text += "  " + stage + '\n';
        for (const std::string& name : madeBy(stage))
            text += entry(name, find(name)->help, 4);
    }
    return text;
}

}  // namespace haustra::store
