// What the pipeline writes with its products as text, and reads back.
#pragma once

#include "core/result.h"
#include "core/tissue.h"
#include "store/case_store.h"
#include "store/notes.h"

#include <string>
#include <vector>

namespace haustra::pipeline {

/// The shortest text that reads back as the same double.
std::string exactText(double value);
/// "x,y,z".
std::string exactText(glm::dvec3 v);
/// "name=x,y,z;" for each point.
std::string exactText(const char* name, const std::vector<glm::dvec3>& points);

using store::notesOf;
using store::setNotes;

/// Attributes "mean-hu", "sd-hu" and "weight" (four numbers, ordered as Tissue), "air-below-hu"
/// and "tagged-above-hu".
void setTissueModel(store::Attributes& attributes, const TissueModel& tissue);
/// The same model, bit for bit. Fails (badInput) where an attribute is missing or no number.
Result<TissueModel> tissueModelOf(const store::Attributes& attributes);

/// Attribute "gravity"; zero where it is missing or damaged.
glm::dvec3 gravityOf(const store::Attributes& attributes);

}  // namespace haustra::pipeline
