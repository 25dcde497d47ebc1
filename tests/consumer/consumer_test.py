#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Tests the installed library as another project uses it without CMake, and the promises of its headers and of
docs/library.md.

consumer_test.py TEST PREFIX FOLDER COMPILER: PREFIX is the folder where promin is installed, FOLDER the test's own.
"""

import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent


def run(*command, **options):
    words = [str(word) for word in command]
    done = subprocess.run(words, capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(words)} ended with {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


class Installed:
    def __init__(self, prefix, folder, compiler):
        self.prefix, self.folder, self.compiler = prefix, folder, compiler
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        (found,) = prefix.glob("lib*/**/pkgconfig/promin.pc")
        self.libraries = found.parent.parent

    def ask_pkg_config(self, *words, libraries=None):
        environment = {**os.environ, "PKG_CONFIG_PATH": str((libraries or self.libraries) / "pkgconfig")}
        return run("pkg-config", *words, env=environment).split()

    def compile(self, source, program, words):
        run(self.compiler, "-std=c++20", "-Wall", "-Wextra", "-Werror", source, "-o", program, *words)

    def headers(self):
        include = self.prefix / "include"
        return sorted(file.relative_to(include) for file in include.glob("promin/**/*.h"))


def needed_libraries(file):
    return re.findall(r"\(NEEDED\).*\[(.+)\]", run("readelf", "--dynamic", "--wide", file))


def expect(is_so, complaint):
    if not is_so:
        sys.exit(complaint)


def links_shared_by_pkg_config(installed):
    program = installed.folder / "shared"
    installed.compile(HERE / "main.cpp", program, installed.ask_pkg_config("--cflags", "--libs", "promin"))
    needed = needed_libraries(program)
    expect(any(re.fullmatch(r"libpromin\.so\.\d+\.\d+", name) for name in needed), f"it needs {needed}")
    environment = {**os.environ, "LD_LIBRARY_PATH": str(installed.libraries)}
    run(program, installed.folder / "picture.png", env=environment)


def links_static_by_pkg_config(installed):
    # This prefix is like one without shared libraries; the linker would prefer those.
    prefix = installed.folder / "prefix"
    shutil.copytree(installed.prefix, prefix, symlinks=True, ignore=shutil.ignore_patterns("bin", "libpromin*.so.*"))
    for link in prefix.glob("lib*/**/libpromin*.so"):
        if link.is_symlink():
            link.unlink()
    libraries = prefix / installed.libraries.relative_to(installed.prefix)
    program = installed.folder / "static"
    flags = installed.ask_pkg_config("--static", "--cflags", "--libs", "promin", libraries=libraries)
    installed.compile(HERE / "main.cpp", program, flags)
    needed = needed_libraries(program)
    expect(not any("promin" in name for name in needed), f"it needs {needed}")
    run(program, installed.folder / "picture.png")


def code_blocks(text, language):
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def builds_the_documented_program(installed):
    """Builds the program of docs/library.md with the CMakeLists.txt of that page, and runs it as a reader would."""
    document = (REPOSITORY / "docs/library.md").read_text()
    (program,) = code_blocks(document, "cpp")
    (project,) = code_blocks(document, "cmake")
    (command,) = re.findall(r"^c\+\+ .*pkg-config.*$", document, re.MULTILINE)
    source = installed.folder / "main.cpp"
    source.write_text(program)
    (installed.folder / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(sample LANGUAGES CXX)\n" + project
    )
    build = installed.folder / "build"
    options = [f"-DCMAKE_PREFIX_PATH={installed.prefix}", f"-DCMAKE_CXX_COMPILER={installed.compiler}"]
    options.append("-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
    run("cmake", "-G", "Ninja", "-S", installed.folder, "-B", build, *options)
    run("cmake", "--build", build)
    # The same program builds with pkg-config.
    environment = {**os.environ, "PKG_CONFIG_PATH": str(installed.libraries / "pkgconfig")}
    run("sh", "-c", command, cwd=installed.folder, env=environment)
    shutil.copy(REPOSITORY / "scenes" / "sphere.gltf", installed.folder / "scene.gltf")
    for sample in (build / "picture", installed.folder / "picture"):
        picture = installed.folder / "picture.png"
        picture.unlink(missing_ok=True)
        run(sample, cwd=installed.folder, env={**os.environ, "LD_LIBRARY_PATH": str(installed.libraries)})
        expect(picture.is_file(), f"{sample} wrote no picture.png")


def headers_stand_alone(installed):
    """Each public header compiles by itself, and includes only the standard library, GLM and the headers these need."""
    include = installed.prefix / "include"

    def find_faults(header):
        source = installed.folder / (str(header).replace("/", "_") + ".cpp")
        # The header is included twice, to check its include guard.
        source.write_text(f"#include <{header}>\n" * 2)
        list_file = source.with_suffix(".d")
        command = [installed.compiler, "-std=c++20", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only"]
        command += [f"-I{include}", "-MD", "-MF", str(list_file), str(source)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            return [f"{header}: {done.stderr}"]
        faults = []
        for name in list_file.read_text().replace("\\\n", " ").split()[2:]:
            file = pathlib.Path(name).absolute()  # a compiler cache may shorten the paths
            is_ours = file.is_relative_to(include / "promin")
            # In Debian 13 the kernel's headers, which the standard library includes, are in /usr/lib/linux/uapi.
            is_systems = r"/(c\+\+|gcc|clang|glm)/|^/usr/include/(?!vulkan|nlohmann)|^/usr/lib/linux/uapi/"
            if not is_ours and not re.search(is_systems, str(file)):
                faults.append(f"{header} includes {file}")
            elif re.search(r"vulkan|nlohmann|OpenImageIO|GLFW|imgui", name):
                faults.append(f"{header} includes {file}")
        return faults

    headers = installed.headers()
    expect(len(headers) >= 20, f"only {len(headers)} headers are installed")
    with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        faults = [fault for found in pool.map(find_faults, headers) for fault in found]
    for header in headers:
        for name in re.findall(r'#\s*include\s*"(.+)"', (include / header).read_text()):
            if not name.startswith("promin/"):
                faults.append(f'{header} includes "{name}"')
    expect(not faults, "\n".join(faults))


def shows_what_is_public(installed):
    """The shared libraries export the symbols that the public headers mark, and nothing else of promin."""
    text = "".join((installed.prefix / "include" / name).read_text() for name in installed.headers())
    text = re.sub(r"//.*|#define.*", "", text)
    classes = set(re.findall(r"\b(?:class|struct) PROMIN_EXPORT (\w+)", text))
    functions = set(re.findall(r"\bPROMIN_EXPORT [^;{}]*?(\w+|operator\(\))\(", text))
    expect(len(classes) >= 8 and len(functions) >= 20, f"too few are marked: {classes}, {functions}")
    faults = []
    for name, wanted in (("libpromin.so", functions), ("libpromin_host.so", {"load_scene", "validate"})):
        table = run("nm", "--dynamic", "--demangle", "--defined-only", installed.libraries / name)
        # The set has qualified names without their arguments, except for templates of the standard library.
        shown = set(re.findall(r" \w (?:(?:typeinfo|typeinfo name|vtable) for )?promin::(?:gpu::)?([\w:~]+)", table))
        for symbol in sorted(shown):
            owner, _, function = symbol.rpartition("::")
            if "::" in owner or not {owner or function, function} & (classes | functions):
                faults.append(f"{name} shows promin::{symbol}, which no public header marks")
        missing = {function for function in wanted if not re.search(rf"\b{re.escape(function)}[(\[]", table)}
        faults += [f"{name} lacks {function}" for function in sorted(missing)]
    expect(not faults, "\n".join(faults))


def reference_is_complete(installed):
    """Doxygen accepts the public headers without a warning. The test is skipped if Doxygen is not installed."""
    if shutil.which("doxygen") is None:
        print("doxygen is not installed")
        sys.exit(77)
    settings = (REPOSITORY / "docs" / "Doxyfile").read_text() + f"\nOUTPUT_DIRECTORY = {installed.folder}\n"
    run("doxygen", "-", cwd=REPOSITORY, input=settings)
    pages = "".join(file.read_text() for file in installed.folder.glob("html/*.html"))
    for name in ("render_progressively", "ExplainedRay", "kMaxSamplesPerPixel"):
        expect(name in pages, f"{name} is not in the reference")


if __name__ == "__main__":
    test, prefix, folder, compiler = sys.argv[1:]
    globals()[test](Installed(pathlib.Path(prefix).resolve(), pathlib.Path(folder), compiler))
