#include "coverage/calibrate.h"

namespace haustra::coverage {

const std::vector<LensModel>& lensModels() {
    using enum Projection;
    static const std::vector<LensModel> models{
        {"kannala-brandt", "k1 t + k2 t^3", equidistance, 2, false, false},
        {"kannala-brandt-4", "k1 t + k2 t^3 + k3 t^5 + k4 t^7", equidistance, 4, false, false},
        {"stereographic", "2 k1 tan(t/2)", stereographic, 1, false, false},
        {"equidistance", "k1 t", equidistance, 1, false, false},
        {"equisolid", "2 k1 sin(t/2)", equisolid, 1, false, false},
        {"orthogonal", "k1 sin(t)", orthogonal, 1, false, false},
        {"opencv-fisheye", "t + k2 t^3 + k3 t^5 + k4 t^7 + k5 t^9", equidistance, 5, false, true},
        {"brown", "s + k2 s^3 + k3 s^5 + k4 s^7 with s = tan(t), decentred", perspective, 4, true,
         true},
        {"brown-radial", "s + k2 s^3 + k3 s^5 + k4 s^7 with s = tan(t)", perspective, 4, false,
         true}};
    return models;
}

const LensModel* findLensModel(std::string_view name) {
    for (const LensModel& model : lensModels())
        if (model.name == name) return &model;
    return nullptr;
}

std::array<double, lensNumbers> numbersOf(const FisheyeLens& lens) {
    return {lens.k[0], lens.k[1], lens.k[2], lens.k[3],          lens.k[4],         lens.mu,
            lens.mv,   lens.u0,   lens.v0,   lens.decentring[0], lens.decentring[1]};
}

const std::array<const char*, lensNumbers>& lensNumberNames() {
    static const std::array<const char*, lensNumbers> names{"k1",  "k2", "k3", "k4", "k5", "m_u",
                                                            "m_v", "u0", "v0", "p1", "p2"};
    return names;
}

}  // namespace haustra::coverage
