// Values as DICOM files that Haustra writes hold them.
#pragma once

#include <string>

namespace haustra::dicom {

/// A UID under 2.25, where any 128-bit number is valid (PS3.5 B.2): the FNV-1a hash of `name`.
/// The same name gives the same UID, everywhere.
std::string uidOf(const std::string& name);

/// A decimal string with as many digits as DICOM's 16 characters hold.
std::string decimal(double value);

}  // namespace haustra::dicom
