#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs the Debian 12 packages that weft needs; says nothing and changes nothing where they are.
#
#   deploy/install-deps.sh [--list] [GROUP...]      --list prints their names instead
#     build    compiles everything
#     libraries  what it links, of build
#     console  builds the console's pages into weftd: npm, unless there is one
#     geo      compiles a weft that reads rasters, projects longitude and latitude, divides meshes
#     python   runs weft for Python from the build folder, longitude and latitude included
#     weftd    runs weftd
#     weft     runs a weft that was compiled with geo; its own weftd needs weftd, too
#     test     what tests/run.sh needs beyond build and geo
#     arm64    for tests/deep.sh arm64: compiles for arm64 on another machine, and runs that
#     solvers  FEniCSx, FreeFem++ and CalculiX, 130 packages, for tests/deep.sh solvers
#     all      build, console, geo and test, the default
set -euo pipefail

libraries=(
  libstdc++-12-dev
  libgrpc++-dev libprotobuf-dev libprotozero-dev                         # the wire
  libcgal-dev libgmp-dev libmpfr-dev libboost-dev                        # exact geometry
  libtbb-dev libsleef-dev libsimde-dev libexpected-dev                   # the engine
  libspdlog-dev libfmt-dev libssl-dev                                    # the server
  libsqlite3-dev libpq-dev prometheus-cpp-dev                            # its jobs and its metrics
  libcli11-dev nlohmann-json3-dev libcairo2-dev fonts-dejavu-core        # the command line
  libyaml-cpp-dev libpugixml-dev                                         # its batches
  zlib1g-dev liblzma-dev libshp-dev                                      # .npz, .vtu, shapefiles
  libgtest-dev libgmock-dev librapidcheck-dev                            # tests
)
build=(
  ca-certificates git clang cmake ninja-build ccache pkg-config python3
  protobuf-compiler protobuf-compiler-grpc
  "${libraries[@]}"
)
arm64=(lld qemu-user-static mmdebstrap arch-test binutils-aarch64-linux-gnu)
geo=(libgdal-dev libproj-dev libmetis-dev)
python=(python3-grpcio python3-protobuf python3-numpy python3-pyproj)
weftd=(
  libgmp10 libgmpxx4ldbl libmpfr6 libtbb12 libsleef3 libspdlog1.10
  libfmt9 libatomic1 libssl3 libsqlite3-0 libpq5 libprometheus-cpp-core1.0 zlib1g
  libshp2         # the files of --http
  ca-certificates # callbacks by https
)
weft=(
  libatomic1 libssl3 libcairo2 fonts-dejavu-core zlib1g liblzma5 libshp2
  libyaml-cpp0.7 libpugixml1v5 libgdal32 libproj25 libmetis5
)
test=(
  g++ libclang-rt-dev llvm # sanitizers, and the names in their reports
  postgresql-15            # the real database
  clang-format clang-tidy shellcheck
  # what reads the files that weft writes, and writes those that it reads
  gmsh python3-gmsh python3-meshio python3-numpy python3-pyshp python3-shapely python3-vtk9 libxdmf3 openfoam
  gdal-bin python3-gdal python3-netcdf4 python3-netgen python3-xarray python3-qgis qgis-providers
  python3-protobuf         # docs/generate.py
  poppler-utils            # drawings
  python3-pyproj           # lengths and angles on the ellipsoid; weft for Python, lonlat=
  buildah debootstrap      # the container, without a daemon
  docker-compose           # its compose.yaml
  python3-seccomp          # the profile of weftd
  python3-grpcio python3-matplotlib python3-scipy                         # weft for Python
  python3-pytest python3-pip python3-setuptools python3-wheel mypy openssl # its tests
  python3-venv python3-pil curl                                           # the documents
  python3-jinja2 python3-yaml # the recipe for conda, the Helm chart
  man-db mandoc zsh fish systemd dpkg-dev file iproute2 procps # what is installed, its packages
  patchelf                 # the wheel
  chromium                 # the console
  # client/examples/go
  golang-go golang-google-grpc-dev golang-google-protobuf-dev golang-github-golang-protobuf-1-5-dev
  protoc-gen-go-1-5 protoc-gen-go-grpc
)
# Some machines bring a newer node; Debian's npm would be in its way.
console=()
command -v npm >/dev/null || console=(nodejs npm)
test+=("${console[@]}") # the linters

solvers=(python3-dolfinx freefem++ calculix-ccx)

list=
[[ ${1:-} != --list ]] || { list=1 && shift; }
wanted=()
for group in "${@:-all}"; do
  case $group in
    libraries) wanted+=("${libraries[@]}") ;;
    arm64) wanted+=("${arm64[@]}") ;;
    build) wanted+=("${build[@]}") ;;
    console) wanted+=("${console[@]}") ;;
    python) wanted+=("${python[@]}") ;;
    geo) wanted+=("${geo[@]}") ;;
    weftd) wanted+=("${weftd[@]}") ;;
    weft) wanted+=("${weft[@]}") ;;
    test) wanted+=("${test[@]}") ;;
    solvers) wanted+=("${solvers[@]}") ;;
    all) wanted+=("${build[@]}" "${console[@]}" "${geo[@]}" "${test[@]}") ;;
    *)
      echo "install-deps.sh: unknown group '$group'; there are build, libraries, console, geo, python, weftd, weft, test, arm64, solvers, all" >&2
      exit 2
      ;;
  esac
done

if [[ $list ]]; then
  printf '%s\n' "${wanted[@]}"
  exit 0
fi

installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' | sed -n 's/^installed //p')
mapfile -t missing < <(printf '%s\n' "${wanted[@]}" | sort -u | grep -vxF -f <(echo "$installed"))
((${#missing[@]})) || exit 0

as_root=()
if ((EUID != 0)); then
  command -v sudo >/dev/null || {
    echo "install-deps.sh: neither root nor sudo; install these as root: ${missing[*]}" >&2
    exit 1
  }
  as_root=(sudo)
fi
echo "installing ${#missing[@]} packages: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -qq --no-install-recommends "${missing[@]}"
