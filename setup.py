"""The wheel's part that is compiled: CMake builds the program and the module into the package. All else: pyproject.toml.

CMAKE_ARGS adds words to CMake's configuration, as -DSOFTGRAIN_ARCH=x86-64-v2."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent
MACOS = sys.platform == "darwin"
ORIGIN = "@loader_path" if MACOS else "$ORIGIN"  # the folder of the file that loads a library
#: Of C and C++, which others in the interpreter use too: never two of them in one process.
SYSTEM = re.compile(r"linux-vdso|ld-linux|lib(c|m|dl|rt|pthread|stdc\+\+|gcc_s)\.so")


def pybind11_folder():
    """Of a pybind11 that pip has brought; Debian's is found by itself."""
    try:
        import pybind11
    except ImportError:
        return []
    return [f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"]


def libraries_of(file):
    """Paths of the shared libraries that a file loads, but for those of C and C++. On macOS delocate finds them, after us."""
    if MACOS:
        return []
    lines = subprocess.run(["ldd", file], capture_output=True, text=True, check=True).stdout.splitlines()
    return [Path(line.split()[2]) for line in lines if "=>" in line and not SYSTEM.search(line)]


class ByCMake(build_ext):
    def build_extension(self, extension):
        build = Path(self.build_temp).resolve()
        package = Path(self.get_ext_fullpath(extension.name)).resolve().parent
        subprocess.run(["cmake", "-S", ROOT, "-B", build, "-DCMAKE_BUILD_TYPE=Release",
                        "-DCMAKE_CXX_FLAGS_RELEASE=-O3 -DNDEBUG", "-DSOFTGRAIN_TESTS=OFF", "-DSOFTGRAIN_STATIC=ON",
                        f"-DCMAKE_BUILD_RPATH={ORIGIN}/lib;{ORIGIN}/../lib", f"-DPython_EXECUTABLE={sys.executable}",
                        "-DSOFTGRAIN_PYTHON_DIR=..", *pybind11_folder(), *shlex.split(os.environ.get("CMAKE_ARGS", ""))],
                       check=True)
        subprocess.run(["cmake", "--build", build, "--parallel", str(os.cpu_count()), "--target", "softgrain_app",
                        "softgrain_python"], check=True)
        module = next((build / "python/softgrain").glob("_core*.so"))
        copies = {package / "bin/softgrain": build / "softgrain", package / module.name: module}
        for library in libraries_of(build / "softgrain") + libraries_of(module):
            copies[package / "lib" / library.name] = library
        for copy, built in copies.items():
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(built, copy)
            subprocess.run(["strip", *(["-x"] if MACOS else ["--strip-unneeded"]), copy], check=True)


setup(license="Apache-2.0", ext_modules=[Extension("softgrain._core", sources=[])], cmdclass={"build_ext": ByCMake})
