#include "core/program_module.h"

#include <filesystem>

#include <dlfcn.h>

namespace haustra {

Result<const void*> loadModule(const char* file, const char* symbol, const char* does) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    const fs::path module = program.parent_path().parent_path() / "lib" / "haustra" / file;
    void* loaded = error ? nullptr : ::dlopen(module.c_str(), RTLD_LAZY | RTLD_LOCAL);
    const void* found = loaded ? ::dlsym(loaded, symbol) : nullptr;
    if (found) return found;
    const char* why = error ? "this program's own folder is not known" : ::dlerror();
    return fail(
        ErrorKind::io,
        std::string(does) + " cannot be loaded: " + (why ? why : "it is of another version"),
        module.string());
}

}  // namespace haustra
