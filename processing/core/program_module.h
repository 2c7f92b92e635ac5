// Parts of a program that are loaded when they are first needed: a library that costs every start
// time and memory is in a module of its own.
#pragma once

#include "core/result.h"

namespace haustra {

/// The one symbol of a module, loaded for good from ../lib/haustra beside the program, installed or
/// not. Fails (io), with the module's place and the loader's words, saying that what `does`
/// ("what reads and writes pictures") cannot be loaded.
Result<const void*> loadModule(const char* file, const char* symbol, const char* does);

}  // namespace haustra
