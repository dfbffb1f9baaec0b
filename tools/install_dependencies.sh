#!/usr/bin/env bash
# Installs the Debian packages that softgrain needs; the only place that names them. Does nothing when all are there.
#   tools/install_dependencies.sh [--with GROUP]...      GROUP: checks, docs, mpi, fit, movie, bench, peers, wheel, viewer, torture, cluster, shells, paraview, vtk, clang, wasm
#   tools/install_dependencies.sh --list                 the table below
# Why each was chosen: docs/decisions/0002-dependencies.md
set -euo pipefail

table() {
  cat <<'TABLE'
build      g++                     C++20 compiler
build      make                    the short commands of the Makefile
build      cmake                   configures the build
build      ninja-build             runs the build
build      git                     the commit that each run records
libraries  libfmt-dev              text formatting
libraries  libcli11-dev            command line arguments
libraries  libtomlplusplus-dev     case files
libraries  nlohmann-json3-dev      run.json and the case schema
libraries  libhdf5-dev             snapshots
libraries  libxxhash-dev           content hash of a snapshot
libraries  libdeflate-dev          compressed files for ParaView, and pages
libraries  libeigen3-dev           sparse matrices of contact problems
python     python3-dev             headers for the Python module
python     pybind11-dev            the Python module
tests      zlib1g-dev              reads what our own files hold
tests      doctest-dev             unit, verification and program tests
tests      python3-pytest          tests of the Python package
tests      python3-nbclient        carries out the notebooks of the examples
tests      python3-ipykernel       carries out the notebooks of the examples
tests      dpkg-dev                the package for Debian
tests      file                    the package for Debian
pictures   python3                 softgrain plot
pictures   python3-numpy           softgrain plot
pictures   python3-matplotlib      softgrain plot
pictures   python3-h5py            softgrain plot reads the snapshots
tests      libopenmpi-dev          softgrain-mpi
tests      openmpi-bin             mpirun starts its ranks
mpi        libopenmpi-dev          softgrain-mpi, whose ranks share a run, 0.06 GB
mpi        openmpi-bin             mpirun starts its ranks
tests      python3-scipy           tests of softgrain fit and voronoi, and of designs
tests      python3-ase             reads our extended XYZ
fit        python3-scipy           softgrain fit and voronoi, designs of softgrain sweep, 60 MB
movie      ffmpeg                  softgrain movie writes MP4, 0.16 GB
checks     python3                 tools/check_layers
checks     clang-format            one format for all sources
checks     clang-tidy              names and common mistakes
docs       mkdocs                  the documentation as a site
docs       mkdocs-material         its theme, with search and a dark mode
docs       libjs-katex             its equations
bench      libbox2d-dev            a peer to measure against
bench      libsiconos-numerics-dev a peer to measure against
bench      liblammps-dev           a peer to measure against
peers      libboost-filesystem-dev builds geomechanics/mpm, a peer whose source is yours
peers      libopenmpi-dev          builds geomechanics/mpm
wheel      python3-build           builds a wheel
wheel      python3-setuptools      calls CMake for it
wheel      python3-wheel           packs it
wheel      python3-pybind11        is found by Python, as pip's is
wheel      python3-venv            tools/check_wheel installs it
viewer     chromium                tests the page of softgrain report
viewer     npm                     tools/check_viewer
torture    tmux                    a real terminal for the test of signals
torture    clang                   libFuzzer
torture    libclang-rt-dev         its sanitizers
torture    g++-aarch64-linux-gnu   the library for 64-bit ARM
torture    qemu-user               runs its tests here
wasm       emscripten              the library for the browser, 0.6 GB
cluster    slurm-wlm               a Slurm of one node for the test of sweeps
cluster    munge                   its authentication
cluster    parallel                GNU parallel carries out a sweep
cluster    snakemake               Snakemake carries out a sweep, 0.7 GB
shells     zsh                     tries its completion
shells     fish                    tries its completion
paraview   paraview                draws the scene of softgrain paraview, 0.7 GB
paraview   python3-paraview        pvbatch
paraview   xvfb                    its window
paraview   xauth                   its window
vtk        python3-vtk9            reads our VTKHDF; not beside python3-paraview
clang      clang                   the second compiler (preset clang)
TABLE
}

groups="build libraries python tests pictures"
while (($#)); do
  case "$1" in
    --list) table && exit 0 ;;
    --with) groups+=" ${2:?--with needs a group: checks, docs, mpi, fit, movie, bench, peers, wheel, viewer, torture, cluster, shells, paraview, vtk, clang or wasm}" && shift 2 ;;
    *) sed -n '2,4s/^# //p' "$0" >&2 && exit 2 ;;
  esac
done
for group in $groups; do
  table | grep -q "^$group " || { echo "$0: no group '$group'; see --list" >&2 && exit 2; }
done

wanted=$(table | awk -v groups=" $groups " 'index(groups, " " $1 " ") && !seen[$2]++')
if ! command -v dpkg-query apt-get >/dev/null; then
  echo "$0: not a Debian system; going on with what is installed. Needed, by their Debian names:" $(awk '{print $2}' <<<"$wanted") >&2
  exit 0
fi

there=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' $(awk '{print $2}' <<<"$wanted") 2>/dev/null |
  awk '$1 == "installed" {print $2}' || true)
command -v npm >/dev/null && there+=$'\nnpm'  # with a Node.js of another source, whose npm conflicts with Debian's
missing=$(awk -v there=" ${there//$'\n'/ } " '!index(there, " " $2 " ")' <<<"$wanted")
[[ -n $missing ]] || exit 0

echo "Installing what is missing:"
awk '{name = $2; $1 = $2 = ""; printf "  %-24s%s\n", name, $0}' <<<"$missing"
packages=$(awk '{print $2}' <<<"$missing")

as_root=()
if ((EUID != 0)); then
  command -v sudo >/dev/null || { echo "Needs root, and there is no sudo. As root: apt-get install" $packages >&2 && exit 1; }
  as_root=(sudo)
fi
apt() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300 "$@" </dev/null; }
install() { apt install -y --no-install-recommends $packages; }

# The first try is silent: on a new machine it only shows that the package lists are missing or old.
install >/dev/null 2>&1 || { apt update && install; } || {
  echo "apt-get could not install:" $packages >&2
  echo "Is this machine online? Otherwise install them from a mirror or medium, then run this again." >&2
  exit 1
}
