// Where loops of bowel touch.
#pragma once

#include "phantom/colon_field.h"
#include "phantom/ileum.h"
#include "phantom/structure.h"

#include <optional>
#include <vector>

namespace haustra::phantom {

/// Gathers, slab by slab, the sites where the lumens of two loops of colon, or of colon and ileum,
/// are less than contactMm apart along a grid's axis.
class ContactFinder {
public:
    explicit ContactFinder(const ColonShape& shape) : shape_(shape) {}

    /// Looks from slices begin…end − 1 of the volumes on to the following ones. `field` has the
    /// volumes' slice k as its slice k + fieldOffset. The same for any number of threads.
    void look(const Volume<std::uint8_t>& lumen, const Volume<std::uint8_t>& sites,
              const ColonField& field, int fieldOffset, const Ileum* ileum, int begin, int end,
              int threads);

    /// Neighbouring sites as one contact each, those of more than 10 mm² only.
    std::vector<Structure::Contact> contacts() const;

private:
    struct Touch {
        bool ileum = false;
        float arcMm = 0.0f, otherArcMm = 0.0f, apartMm = 0.0f, areaMm2 = 0.0f;
        glm::vec3 at{0.0f};
    };
    /// Where two lumens touch, by a voxel of each, `a` and `b`, mm; `depthMm` is the depth of `a`
    /// inside its lumen and that of `b` inside the other, added.
    static std::optional<Touch> touchAt(glm::dvec3 a, glm::dvec3 b, double depthMm);
    /// Of two voxels of the colon, unless one bend holds both.
    std::optional<Touch> touchOfLoops(glm::ivec3 a, glm::ivec3 b, const Grid& grid,
                                      const ColonField& field, int fieldOffset) const;
    /// Of a voxel of the colon and one of the ileum, unless they lie at its valve.
    std::optional<Touch> touchOfIleum(glm::ivec3 a, glm::ivec3 b, const Grid& grid,
                                      const ColonField& field, int fieldOffset,
                                      const Ileum& ileum) const;

    const ColonShape& shape_;
    std::vector<Touch> touches_;
};

}  // namespace haustra::phantom
