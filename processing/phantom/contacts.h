// Where loops of bowel touch.
#pragma once

#include "phantom/colon_field.h"
#include "phantom/ileum.h"
#include "phantom/structure.h"

namespace haustra::phantom {

/// Gathers, slab by slab, the sites where the lumens of two loops of colon, or of colon and ileum,
/// are less than kContactMm apart along a grid's axis.
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
    const ColonShape& shape_;
    std::vector<Touch> touches_;
};

}  // namespace haustra::phantom
