// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/open_pictures.h"

#include <dlfcn.h>
#include <link.h>
#include <sys/auxv.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <new>
#include <string>
#include <vector>

#include "core/address_space.h"
#include "core/parallel.h"
#include "promin/error.h"

namespace promin {
namespace fs = std::filesystem;

namespace {

constexpr const char* kFileName = "libpromin_pictures.so";
constexpr const char* kListEnding = ".libraries";
constexpr const char* kCure = "install all of promin, or name the plugin's folder in PROMIN_PLUGINS";

/// Returns the file of the program: the file that the system reports, or otherwise the name with which the program was
/// started.
fs::path find_program() {
  const fs::path link = "/proc/self/exe";
  std::error_code error;
  const auto* called = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
  return fs::exists(link, error) || called == nullptr ? link : fs::path(called);
}

/// Returns the file that contains this code: a shared library, or the program itself.
fs::path find_own_file() {
  Dl_info info{};
  link_map* map = nullptr;
  const bool is_found = dladdr1(reinterpret_cast<const void*>(&open_pictures), &info, reinterpret_cast<void**>(&map),
                                RTLD_DL_LINKMAP) != 0;
  // The loader stores an empty name for the program, and dladdr() only returns the name with which it was started.
  return is_found && map != nullptr && *map->l_name != '\0' ? fs::path(map->l_name) : find_program();
}

/// Returns the folders in which the loader looks for libraries of the program: folders linked into the program, folders
/// of the environment, and folders of the system.
std::vector<fs::path> list_library_folders() {
  std::vector<fs::path> folders;
  void* program = dlopen(nullptr, RTLD_LAZY);
  Dl_serinfo size{};
  if (program == nullptr || dlinfo(program, RTLD_DI_SERINFOSIZE, &size) != 0) return folders;
  std::vector<std::max_align_t> memory(size.dls_size / sizeof(std::max_align_t) + 1);
  auto* info = new (memory.data()) Dl_serinfo(size);
  if (dlinfo(program, RTLD_DI_SERINFOSIZE, info) != 0 || dlinfo(program, RTLD_DI_SERINFO, info) != 0) return folders;
  for (unsigned i = 0; i < info->dls_cnt; ++i) folders.emplace_back(info->dls_serpath[i].dls_name);
  return folders;
}

std::vector<fs::path> list_folders() {
  if (const char* given = secure_getenv("PROMIN_PLUGINS"); given != nullptr && *given != '\0') return {given};
  std::vector<fs::path> folders;
  const auto add = [&](const fs::path& folder) {
    const fs::path normal = folder.lexically_normal();
    if (std::find(folders.begin(), folders.end(), normal) == folders.end()) folders.push_back(normal);
  };
  for (const fs::path& file : {find_own_file(), find_program()}) {
    std::error_code error;
    const fs::path folder = fs::canonical(file, error).parent_path();
    if (error) continue;
    // These folders are relative to a program: the first as built and as usually installed, the other as installed with
    // a library folder for each type of machine.
    add(folder / "../lib/promin");
    add(folder / PROMIN_PLUGIN_FOLDER);
    // This folder is relative to a library. In the Python package, the plugin is beside the module itself.
    add(folder / "promin");
    if (folder.filename() == "promin") add(folder);
  }
  // The code may be linked statically into a program in any folder. The package of the static library links the
  // plugin's folder into the program; otherwise the library knows the folder where it was to be installed.
  for (const fs::path& folder : list_library_folders()) {
    if (folder.filename() == "promin") add(folder);
  }
  add(PROMIN_INSTALLED_PLUGIN_FOLDER);
  return folders;
}

std::string list_names(const std::vector<fs::path>& folders) {
  std::string names;
  for (const fs::path& folder : folders) names += (names.empty() ? "" : ", ") + folder.string();
  return names;
}

std::string take_loader_error() {
  const char* text = dlerror();
  return text == nullptr ? "no reason is given" : text;
}

template <typename Function>
void find_function(void* library, const char* name, const fs::path& file, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (function == nullptr) {
    throw RunError({"plugin.damaged", "the plugin that reads pictures is damaged (" + take_loader_error() + ")",
                    file.string(), kCure});
  }
}

/// Flags for opening the plugin. Its symbols are local, so that the symbols of OpenImageIO's libraries do not conflict
/// with those of a Vulkan driver. They are resolved lazily, because few functions of these libraries are called.
/// Nothing is closed again, because the libraries run code at the end of the process.
constexpr int kHow = RTLD_LAZY | RTLD_LOCAL;

/// Opens the libraries that the plugin needs one by one, each after the libraries that it needs itself. The loader then
/// looks for its symbols in few libraries and not in all 260, which halves the processor time. Libraries that cannot be
/// opened here or are missing in the list are opened together with the plugin.
void open_libraries_of(const fs::path& plugin) {
  std::ifstream list(fs::path(plugin).replace_extension(kListEnding));
  for (std::string name; std::getline(list, name);) dlopen(name.c_str(), kHow);
}

fs::path find_plugin() {
  const std::vector<fs::path> folders = list_folders();
  for (const fs::path& folder : folders) {
    std::error_code error;
    if (fs::is_regular_file(folder / kFileName, error)) return folder / kFileName;
  }
  throw RunError(
      {"plugin.missing",
       std::string("the plugin that reads pictures, ") + kFileName + ", is missing in " + list_names(folders), "",
       kCure});
}

/// Throws RunError if threads or memory are too few. OpenImageIO's libraries start threads when they are loaded. If
/// these or their memory are not available, the libraries wait forever or end the process. One library starts four
/// threads, and OpenBLAS starts one for each core except the first. For an EXR, OpenEXR starts one for each core. The
/// numbers were measured on Debian 12, where 536 MiB are enough with one core and 672 MiB with two.
void check_limits() {
  constexpr uint64_t kBytes = uint64_t{416} << 20;
  constexpr uint64_t kCoreBytes = uint64_t{144} << 20;
  const unsigned cores = core_count();
  if (auto lack = find_lack_of_space("the libraries that read pictures", kBytes + kCoreBytes * cores)) {
    throw RunError(*lack);
  }
  if (!can_start_threads(size_t{4} + (cores - 1) + cores)) throw RunError(explain_no_threads());
}

PicturesPlugin load_plugin() {
  const fs::path file = find_plugin();
  check_limits();
  open_libraries_of(file);
  void* library = dlopen(file.c_str(), kHow);
  if (library == nullptr) {
    const char* cure = "install OpenImageIO, for example with the package libopenimageio-dev";
    throw RunError({"plugin.loading", "the plugin that reads pictures cannot be loaded (" + take_loader_error() + ")",
                    file.string(), cure_short_memory(cure)});
  }
  PicturesPlugin plugin;
  find_function(library, "promin_pictures_interface", file, plugin.interface);
  if (const uint32_t version = plugin.interface(); version != PROMIN_PICTURES_INTERFACE) {
    throw RunError({"plugin.version",
                    "the plugin that reads pictures belongs to another version of promin (its interface is " +
                        std::to_string(version) + ", not " + std::to_string(PROMIN_PICTURES_INTERFACE) + ")",
                    file.string(), kCure});
  }
  find_function(library, "promin_pictures_open", file, plugin.open);
  find_function(library, "promin_pictures_open_bytes", file, plugin.open_bytes);
  find_function(library, "promin_pictures_read_rgb", file, plugin.read_rgb);
  find_function(library, "promin_pictures_read_rgba", file, plugin.read_rgba);
  find_function(library, "promin_pictures_describe_part", file, plugin.describe_part);
  find_function(library, "promin_pictures_read_rows", file, plugin.read_rows);
  find_function(library, "promin_pictures_write", file, plugin.write);
  find_function(library, "promin_pictures_draw_text", file, plugin.draw_text);
  find_function(library, "promin_pictures_close", file, plugin.close);
  return plugin;
}

}  // namespace

const PicturesPlugin& open_pictures() {
  static const PicturesPlugin plugin = load_plugin();
  return plugin;
}

}  // namespace promin
