# SPDX-License-Identifier: Apache-2.0
# Packages for Debian: `cpack` in the build folder makes weft, weftd, python3-weft, libweft0, libweft-dev
# and weft-protocol-dev; deploy/arm64/packages.sh those for arm64.
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL weft weftd python3-weft libweft0 library protocol)
set(CPACK_COMPONENTS_GROUPING IGNORE)
# Absolute folders, such as /etc, need DESTDIR.
set(CPACK_SET_DESTDIR ON)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_PACKAGE_VENDOR weft)
# Whoever publishes packages answers for them: the default, of a name that never resolves (RFC 2606),
# says that nobody does.
set(WEFT_MAINTAINER "Unpublished build of weft <nobody@weft.invalid>" CACHE STRING
  "Maintainer of the packages for Debian, as NAME <ADDRESS>")
set(CPACK_PACKAGE_CONTACT "${WEFT_MAINTAINER}")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
if(CMAKE_CROSSCOMPILING)
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
endif()
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
# Which package programs need that are linked with libweft.so.0.
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")

set(CPACK_DEBIAN_WEFT_PACKAGE_NAME weft)
set(CPACK_DEBIAN_WEFT_DESCRIPTION "Meshes of planar domains, with guaranteed angles: command line
Makes triangle meshes for simulation, by a server, or one that it starts itself if
weftd is installed. Reads and writes the usual formats of domains and meshes.")
set(CPACK_DEBIAN_WEFT_PACKAGE_SHLIBDEPS ON)
# Fonts of drawings, and libraries that dpkg-shlibdeps does not see, because they are loaded when they are
# needed.
get_property(loaded_later GLOBAL PROPERTY weft_packages_of_weft)
list(JOIN loaded_later ", " loaded_later)
set(CPACK_DEBIAN_WEFT_PACKAGE_DEPENDS "fonts-dejavu-core, ${loaded_later}")
set(CPACK_DEBIAN_WEFT_PACKAGE_RECOMMENDS weftd)
set(CPACK_DEBIAN_WEFT_PACKAGE_SUGGESTS libgdal32) # of rasters and vectors; 160 MB with what it needs

set(CPACK_DEBIAN_WEFTD_PACKAGE_NAME weftd)
set(CPACK_DEBIAN_WEFTD_DESCRIPTION "Meshes of planar domains, with guaranteed angles: server
Refines on all cores, streams meshes over gRPC while it does, and keeps jobs. Comes
with a service for systemd, which listens on 127.0.0.1:7421.")
set(CPACK_DEBIAN_WEFTD_PACKAGE_SHLIBDEPS ON)
get_property(loaded_later GLOBAL PROPERTY weft_packages_of_weftd)
list(JOIN loaded_later ", " loaded_later)
set(CPACK_DEBIAN_WEFTD_PACKAGE_DEPENDS
  "systemd | systemd-standalone-sysusers | systemd-sysusers, ${loaded_later}")
set(CPACK_DEBIAN_WEFTD_PACKAGE_SUGGESTS "weft, ca-certificates")
set(scripts ${CMAKE_CURRENT_SOURCE_DIR}/debian)
set(CPACK_DEBIAN_WEFTD_PACKAGE_CONTROL_EXTRA
  ${scripts}/weftd/conffiles ${scripts}/weftd/postinst ${scripts}/weftd/prerm ${scripts}/weftd/postrm)

set(CPACK_DEBIAN_PYTHON3-WEFT_PACKAGE_NAME python3-weft)
set(CPACK_DEBIAN_PYTHON3-WEFT_DESCRIPTION "Meshes of planar domains, with guaranteed angles: Python
Meshes as numpy arrays, from a server, from one that it starts itself if weftd is
installed, or made in the process itself if libweft0 is.")
set(CPACK_DEBIAN_PYTHON3-WEFT_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON3-WEFT_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON3-WEFT_PACKAGE_DEPENDS
  "python3 (>= 3.11), python3-grpcio, python3-numpy, python3-protobuf")
# The library goes on serving what was made for an earlier one: weft/c.h.
set(CPACK_DEBIAN_PYTHON3-WEFT_PACKAGE_RECOMMENDS "weftd, libweft0 (>= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_PYTHON3-WEFT_PACKAGE_CONTROL_EXTRA
  ${scripts}/python3-weft/postinst ${scripts}/python3-weft/prerm)

set(CPACK_DEBIAN_LIBWEFT0_PACKAGE_NAME libweft0)
set(CPACK_DEBIAN_LIBWEFT0_DESCRIPTION "Meshes of planar domains, with guaranteed angles: library
The engine of weftd as a shared library with an interface for C, which python3-weft
loads to make meshes without a server.")
set(CPACK_DEBIAN_LIBWEFT0_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBWEFT0_PACKAGE_SHLIBDEPS ON)
get_property(loaded_later GLOBAL PROPERTY weft_packages_of_libweft.so.0)
list(JOIN loaded_later ", " loaded_later)
set(CPACK_DEBIAN_LIBWEFT0_PACKAGE_DEPENDS "${loaded_later}")
set(CPACK_DEBIAN_LIBWEFT0_PACKAGE_SUGGESTS libgdal32)

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libweft-dev)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "Meshes of planar domains, with guaranteed angles: development files
Headers for C and C++, the static library for C++, and where they are, for CMake and
pkg-config.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "libweft0 (= ${PROJECT_VERSION}), libexpected-dev, \
libtbb-dev, libsleef-dev, libssl-dev, libmpfr-dev, libgmp-dev")

set(CPACK_DEBIAN_PROTOCOL_PACKAGE_NAME weft-protocol-dev)
set(CPACK_DEBIAN_PROTOCOL_DESCRIPTION "Meshes of planar domains, with guaranteed angles: protocol
The .proto files of the server's gRPC services, for clients in other languages, and
where they are, for pkg-config.")
set(CPACK_DEBIAN_PROTOCOL_PACKAGE_SECTION devel)
set(CPACK_DEBIAN_PROTOCOL_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PROTOCOL_PACKAGE_RECOMMENDS protobuf-compiler)

include(CPack)
