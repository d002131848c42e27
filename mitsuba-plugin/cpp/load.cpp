/**
 * The plugin that Mitsuba opens. It refuses a Mitsuba or a Dr.Jit of another version in a sentence and opens the plugin proper,
 * `<name>.impl.so` beside it, which fits one version alone: opened as it is, a wrong one ends in a mangled symbol, or runs and
 * later ends the process. So nothing of Mitsuba is linked with or called here.
 */
#include <dlfcn.h>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace {

namespace fs = std::filesystem;

/// Mitsuba's function that takes plugins; it is handed on as it came.
using Register = void (*)();

struct Versions {
    std::string mitsuba, drjit;

    std::string text() const {
        auto known = [](const std::string &version) { return version.empty() ? "of unknown version" : version; };
        return "Mitsuba " + known(mitsuba) + " with Dr.Jit " + known(drjit);
    }
};

fs::path library_of(const void *function) {
    Dl_info info{};
    dladdr(function, &info);
    return fs::path(info.dli_fname ? info.dli_fname : "").lexically_normal();
}

/// Version of an installed Python package by its record, `<name>-<version>.dist-info`; empty where it has none.
std::string version(const fs::path &packages, const std::string &name) {
    std::error_code error;
    for (const fs::directory_entry &entry : fs::directory_iterator(packages, error)) {
        std::string record = entry.path().stem();
        if (entry.path().extension() == ".dist-info" && record.rfind(name + "-", 0) == 0)
            return record.substr(name.size() + 1);
    }
    return "";
}

} // namespace

extern "C" __attribute__((visibility("default"))) void init_plugin(std::string_view name, Register fn) {
    // Versions of the headers that the build found.
    const Versions built{ PROB_WATER_MITSUBA, PROB_WATER_DRJIT };
    const fs::path packages = library_of((const void *) fn).parent_path().parent_path();
    const Versions running{ version(packages, "mitsuba"), version(packages, "drjit") };
    auto refuse = [&](const std::string &reason) {
        throw std::runtime_error(std::string(name) + ": this plugin was built for " + built.text() + "; running is " +
                                 running.text() + reason + ". Use it with 'pip install mitsuba==" + built.mitsuba + "'");
    };
    auto differs = [](const std::string &a, const std::string &b) { return !b.empty() && a != b; };
    if (differs(built.mitsuba, running.mitsuba) || differs(built.drjit, running.drjit))
        refuse("");

    void *plugin = dlopen(library_of((const void *) init_plugin).replace_extension(".impl.so").c_str(), RTLD_NOW | RTLD_LOCAL);
    void *entry = plugin ? dlsym(plugin, "init_plugin") : nullptr;
    if (!entry)
        refuse(std::string(", where it cannot be loaded: ") + dlerror());
    ((void (*)(std::string_view, Register)) entry)(name, fn);
}
