#include "phantom/anatomy.h"

#include "phantom/implicit.h"
#include "phantom/random.h"

#include <algorithm>
#include <cmath>

namespace haustra::phantom {
namespace {

constexpr double topMm = 1000.0;

class Builder {
public:
    Builder(std::uint64_t seed, const BodyPlan& body) : seed_(seed), body_(body) {}
    std::vector<Solid> build();

private:
    void add(glm::dvec3 low, glm::dvec3 high, std::function<double(glm::dvec3)> distance,
             std::function<double(glm::dvec3, double)> hu, Site site = Site::elsewhere) {
        solids_.push_back(
            {low, high, std::move(distance), std::move(hu), -1e9, std::uint8_t(site)});
    }
    void addEllipsoid(glm::dvec3 center, glm::dvec3 semi,
                      std::function<double(glm::dvec3, double)> hu) {
        add(
            center - semi - 2.0, center + semi + 2.0,
            [=](glm::dvec3 p) { return ellipsoid(p, center, semi); }, std::move(hu));
    }
    void addCapsule(glm::dvec3 a, glm::dvec3 b, double r,
                    std::function<double(glm::dvec3, double)> hu) {
        add(
            glm::min(a, b) - r - 2.0, glm::max(a, b) + r + 2.0,
            [=](glm::dvec3 p) { return capsule(p, a, b, r); }, std::move(hu));
    }
    std::uint64_t next() { return mixBits(seed_ + ++counter_); }

    void addTable();
    void addBodyWall();
    void addMuscles();
    void addLungs();
    void addOrgans();
    void addSpine();
    void addPelvis();
    void addRibs();

    std::uint64_t seed_, counter_ = 0;
    BodyPlan body_;
    std::vector<Solid> solids_;
};

void Builder::addTable() {
    // Along y under the patient's back or belly, along x beside one who lies on the side.
    const glm::dvec3 down = gravityDirection(body_.position);
    const int axis = down.x != 0.0 ? 0 : 1, across = 1 - axis;
    const double side = down[axis], top = axis == 0 ? 176.0 * body_.widthScale : 112.0;
    // A shallow trough of carbon fibre over foam, touching the body at its lowest line.
    constexpr double radius = 420.0;
    const auto depth = [=](glm::dvec3 p) {
        return std::hypot(p[across], side * p[axis] - (top - radius)) - radius;
    };
    glm::dvec3 half(0.0, 0.0, topMm);
    half[axis] = 400.0, half[across] = 210.0;
    add(
        -half, half,
        [=](glm::dvec3 p) {
            return side * p[axis] > 0.0
                       ? std::max(std::abs(depth(p) - 11.0) - 11.0, std::abs(p[across]) - 205.0)
                       : 99.0;
        },
        [=](glm::dvec3, double d) { return d > -2.2 ? -180.0 : -880.0; }, Site::outsideBody);
}

void Builder::addBodyWall() {
    const BodyPlan body = body_;
    const std::uint64_t a = next(), b = next(), c = next();
    const double fat = body.fatMm;
    add(
        {-200, -200, -topMm}, {200, 200, topMm}, [=](glm::dvec3 p) { return body.skin(p); },
        [=](glm::dvec3 p, double d) {
            if (d > -2.0) return 10.0;
            const double layer = fat + 3.0 * valueNoise(a, p, 60.0);
            if (d > -layer) return -105.0 + 6.0 * valueNoise(b, p, 12.0);
            if (body.cavity(p) > 0.0) {
                // Muscle with seams of fat between its bellies.
                const double seam = std::abs(valueNoise(a, p * glm::dvec3(1, 1, 0.35), 21.0));
                return seam < 0.045 ? -40.0 : 56.0 + 8.0 * valueNoise(b, p, 6.0);
            }
            // Mesentery: fat with vessels.
            const double vessel = std::hypot(valueNoise(c, p, 19.0), valueNoise(c + 1, p, 19.0));
            return vessel < 0.07 ? 45.0 : -98.0 + 10.0 * valueNoise(b, p, 15.0);
        });
}

void Builder::addMuscles() {
    for (double side : {-1.0, 1.0}) {
        const auto muscle = tissue(55, 8, next(), 6.0);
        addCapsule({side * 36, 46, 320}, {side * 48, 36, 180}, 14, muscle);  // psoas
        addCapsule({side * 48, 36, 180}, {side * 84, -12, 95}, 17, muscle);  // iliopsoas
        addEllipsoid({side * 34, 78, 250}, {26, 19, 190}, muscle);           // erector spinae
        addEllipsoid({side * 62, 74, 90}, {54, 24, 78}, muscle);             // gluteus
        addEllipsoid({side * 58, 30, 78}, {18, 34, 34}, muscle);             // obturator
        addEllipsoid({side * 88, -10, 20}, {58, 62, 90}, muscle);            // thigh
    }
    addEllipsoid({0, 30, 12}, {46, 40, 26}, tissue(50, 8, next(), 8.0));  // pelvic floor
}

void Builder::addLungs() {
    const BodyPlan body = body_;
    const std::uint64_t seed = next();
    add(
        {-150, -110, 285}, {150, 110, topMm},
        [=](glm::dvec3 p) {
            const double dome = 0.75 * (BodyPlan::diaphragmZ(p.x, p.y) - p.z);
            const double chest = body.skin(p) + body.fatMm + 12.0;
            const double mediastinum = 24.0 + 0.25 * std::max(0.0, -p.y) - std::abs(p.x);
            return std::max({dome, chest, mediastinum});
        },
        [=](glm::dvec3 p, double) {
            const double vessel =
                std::hypot(valueNoise(seed, p, 15.0), valueNoise(seed + 1, p, 15.0));
            return vessel < 0.09 ? -100.0 : -870.0 + 35.0 * valueNoise(seed + 2, p, 5.0);
        },
        Site::lung);
}

void Builder::addOrgans() {
    const BodyPlan body = body_;
    const std::uint64_t seed = next();
    // Liver: under the right dome, thin to the left.
    add(
        {-150, -110, 240}, {60, 100, topMm},
        [=](glm::dvec3 p) {
            const double mass = std::min(ellipsoid(p, {-66, 2, 338}, {78, 82, 66}),
                                         ellipsoid(p, {-5, -30, 362}, {60, 45, 34}));
            return std::max(
                {mass, body.cavity(p) - 4.0, 0.75 * (p.z + 6.0 - BodyPlan::diaphragmZ(p.x, p.y))});
        },
        [=](glm::dvec3 p, double) {
            const double vessel =
                std::hypot(valueNoise(seed, p, 24.0), valueNoise(seed + 1, p, 24.0));
            return (vessel < 0.08 ? 48.0 : 64.0) + 5.0 * valueNoise(seed + 2, p, 9.0);
        });
    addEllipsoid({14, -34, 436}, {58, 48, 48}, tissue(45, 4, next()));   // heart
    addEllipsoid({92, 48, 338}, {30, 24, 42}, tissue(52, 6, next()));    // spleen
    addEllipsoid({0, 2, 300}, {62, 12, 16}, tissue(38, 10, next(), 5));  // pancreas
    for (double side : {-1.0, 1.0}) {
        const std::uint64_t texture = next();
        const glm::dvec3 center{side * 66, 46, side < 0 ? 262.0 : 276.0};
        const auto kidney = [=](glm::dvec3 p) {
            return std::max(ellipsoid(p, center, {28, 25, 53}),
                            -ellipsoid(p, center - glm::dvec3(side * 20, 4, 0), {16, 12, 24}));
        };
        add(center - glm::dvec3(30, 27, 55), center + glm::dvec3(30, 27, 55), kidney,
            tissue(34, 7, texture));
    }
    addCapsule({4, 16, -20}, {4, 12, 60}, 1.0, tissue(30, 0, next()));
    addEllipsoid({0, -42, 70}, {34, 26, 24}, tissue(8, 3, next()));         // bladder
    addEllipsoid({0, -8, 62}, {22, 18, 18}, tissue(42, 8, next()));         // prostate or uterus
    addCapsule({10, 16, 180}, {6, 22, 420}, 9.5, tissue(42, 3, next()));    // aorta
    addCapsule({-18, 16, 180}, {-20, 14, 420}, 10, tissue(38, 3, next()));  // vena cava
    for (double side : {-1.0, 1.0}) {
        addCapsule({side * 4, 16, 182}, {side * 52, -10, 110}, 6, tissue(42, 3, next()));
        addCapsule({side * 52, -10, 110}, {side * 62, -58, 50}, 5.5, tissue(42, 3, next()));
    }
}

void Builder::addSpine() {
    const auto spongy = bone(1.6, 620, 210, next());
    for (int n = 0; n < 8; ++n) {
        const double z = 184.0 + 35.0 * n, y = BodyPlan::spineY(z), half = 13.0 + 0.2 * n;
        add(
            {-26, y - 22, z - 16}, {26, y + 22, z + 16},
            [=](glm::dvec3 p) {
                const double waist = 1.5 * (1.0 - std::min(1.0, std::abs(p.z - z) / half));
                const double round =
                    ellipsoid({p.x, p.y, 0}, {0, y, 0}, {23 - waist, 17 - waist, 1e6});
                return smoothMax(round, std::abs(p.z - z) - half, 3.0);
            },
            spongy);
        addEllipsoid({0, y, z + 17.5}, {21, 15, 4.5}, tissue(80, 10, next(), 5));  // disc
        add(
            {-28, y + 12, z - 14}, {28, y + 62, z + 14},  // arch and processes
            [=](glm::dvec3 p) {
                const double ring = std::max(std::abs(std::hypot(p.x, p.y - y - 25.0) - 11.5) - 3.0,
                                             std::abs(p.z - z) - 9.0);
                const double spine = capsule(p, {0, y + 38, z}, {0, y + 54, z - 9}, 4.0);
                return std::min(ring, spine);
            },
            bone(1.2, 650, 300, next()));
        for (double side : {-1.0, 1.0}) {
            addCapsule({side * 13, y + 24, z}, {side * 36, y + 30, z + 3}, 4.0,
                       bone(1.2, 600, 260, next()));
        }
    }
    // Sacrum and coccyx follow the same curve, curving backward.
    const auto sacral = bone(1.6, 520, 190, next());
    add(
        {-55, 20, 50}, {55, 110, 170},
        [](glm::dvec3 p) {
            const double y = BodyPlan::spineY(p.z) + 3.0 + 0.006 * p.x * p.x;
            const double half = 10.0 + 40.0 * smoothstep(62, 130, p.z),
                         deep = 5.0 + 10.0 * smoothstep(80, 165, p.z);
            return smoothMax(ellipsoid({p.x, p.y, 0}, {0, y, 0}, {half, deep, 1e6}),
                             std::max(54.0 - p.z, p.z - 167.0), 3.0);
        },
        sacral);
}

void Builder::addPelvis() {
    add(
        {-170, -90, 75}, {170, 110, 210}, [](glm::dvec3 p) { return BodyPlan::iliacWing(p); },
        bone(2.2, 780, 260, next()));
    for (double side : {-1.0, 1.0}) {
        const auto hip = bone(2.0, 800, 280, next());
        const glm::dvec3 head{side * 90, 4, 70};
        add(
            head - glm::dvec3(40), head + glm::dvec3(40),
            [=](glm::dvec3 p) {  // acetabulum: a cup open to the side
                const double shell = std::abs(glm::distance(p, head) - 30.0) - 3.5;
                return std::max({shell, side * (p.x - head.x) - 0.6 * (p.z - head.z) - 14.0});
            },
            hip);
        addCapsule({side * 78, 14, 50}, {side * 62, 44, 14}, 12, hip);   // ischium
        addCapsule({side * 76, -16, 62}, {side * 14, -50, 48}, 9, hip);  // pubis
        addCapsule({side * 14, -50, 44}, {side * 52, 14, 8}, 7, hip);
        const auto femur = bone(3.0, 950, 320, next());
        addEllipsoid(head, {24, 24, 24}, femur);
        addCapsule(head, {side * 122, 14, 42}, 14, femur);
        addCapsule({side * 126, 14, 46}, {side * 122, 10, -60}, 17, femur);
    }
}

void Builder::addRibs() {
    const BodyPlan body = body_;
    const auto marrow = bone(1.6, 700, 200, next());
    add(
        {-175, -90, 225}, {175, 110, topMm},
        [=](glm::dvec3 p) {
            // Ribs run down from back to front, under the fat and outside the pleura.
            const double depth = body.skin(p) + body.fatMm + 7.0;
            if (std::abs(depth) > 7.0 || std::abs(p.x) < 22.0) return 99.0;
            const double along = p.z + 0.55 * (60.0 - p.y) - 296.0;
            const double rib = along - 27.0 * std::round(along / 27.0);
            // The last two are short.
            const double end = p.z < 300.0 ? -10.0 - p.y + 0.9 * (300.0 - p.z) : -70.0 - p.y;
            return std::max({std::hypot(depth * 1.25, rib * 0.62) - 4.2, end, -along - 14.0});
        },
        marrow);
}

std::vector<Solid> Builder::build() {
    addTable();
    addBodyWall();
    addMuscles();
    addLungs();
    addOrgans();
    addSpine();
    addPelvis();
    addRibs();
    return std::move(solids_);
}

constexpr double titaniumHu = 8000.0, cobaltChromeHu = 20000.0, polyethyleneHu = -80.0;

}  // namespace

std::vector<Solid> makeMetalHip(std::uint64_t seed) {
    Random random(seed, 45);
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    const double headMm = 14.0 + 2.0 * random.index(3), linerMm = headMm + 7.0,
                 cupMm = linerMm + 4.0;
    const glm::dvec3 head{side * 90, 4, 70}, neck{side * 116, 13, 47}, stem{side * 122, 11, -40};
    const glm::dvec3 outward = glm::normalize(glm::dvec3(side, -0.3, -0.9));
    std::vector<Solid> solids;
    const auto add = [&](double hu, std::function<double(glm::dvec3)> distance) {
        solids.push_back({head - glm::dvec3(60, 40, 130), head + glm::dvec3(60, 40, 40),
                          std::move(distance), tissue(hu, 0.0, 0)});
    };
    const auto ball = [=](glm::dvec3 p, double radius) { return glm::distance(p, head) - radius; };
    const auto cap = [=](glm::dvec3 p) { return glm::dot(p - head, outward) - 2.0; };
    add(45.0, [=](glm::dvec3 p) { return ball(p, cupMm); });  // what was the joint
    add(titaniumHu, [=](glm::dvec3 p) { return std::max(ball(p, cupMm), cap(p)); });
    add(polyethyleneHu, [=](glm::dvec3 p) { return std::max(ball(p, linerMm), cap(p)); });
    add(titaniumHu, [=](glm::dvec3 p) {
        return std::min(capsule(p, head, neck, 6.5), capsule(p, neck, stem, 7.0));
    });
    add(cobaltChromeHu, [=](glm::dvec3 p) { return ball(p, headMm); });
    return solids;
}

std::vector<Solid> makeAnatomy(std::uint64_t seed, const BodyPlan& body) {
    return Builder(mixBits(seed + 11), body).build();
}

}  // namespace haustra::phantom
