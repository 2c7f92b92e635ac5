// The colon from outside, as the reader turns it.
#pragma once

#include "core/orbit.h"
#include "reader/case_info.h"

#include <memory>

namespace haustra::reader {

/// Belongs to one thread. Until the reader turns or enlarges it, it is the whole colon from the
/// front.
class OutsideView {
public:
    /// Another case is open.
    void open(std::shared_ptr<const CaseInfo> info);
    void setPaneSize(glm::ivec2 pixels);

    /// The window itself marks reader and bookmarks: they move without a new picture.
    Overview state() const;
    const Orbit& orbit() const { return orbit_; }
    void turn(double azimuthDegrees, double elevationDegrees);
    void zoom(double factor);
    /// From the front again.
    void reset();
    bool showsBody() const { return showsBody_; }
    void setShowsBody(bool shows) { showsBody_ = shows; }

private:
    std::shared_ptr<const CaseInfo> case_;
    Orbit orbit_;
    glm::ivec2 paneSize_{1, 1};
    bool isOwn_ = false, showsBody_ = true;  // own: turned by the reader
};

}  // namespace haustra::reader
