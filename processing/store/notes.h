// What a product's maker found worth telling, kept with the product.
#pragma once

#include "store/case_store.h"

#include <string>
#include <vector>

namespace haustra::store {

/// Attribute "notes", a line each; none where there is nothing to note. A line that begins with
/// "warning: " is for the reader, too (case_trust.h).
void setNotes(Attributes& attributes, const std::vector<std::string>& notes);
std::vector<std::string> notesOf(const Attributes& attributes);

}  // namespace haustra::store
