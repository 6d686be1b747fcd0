# SPDX-License-Identifier: Apache-2.0
# Run by `cmake --install` and cpack: the unit of weftd, its user, and its variables. Takes `source`,
# the folder of their templates, `made`, a folder to work in, and `bindir`, relative to the prefix.
include("${CMAKE_CURRENT_LIST_DIR}/folders.cmake")
set(weftd "${CMAKE_INSTALL_PREFIX}/${bindir}/weftd")
set(variables "${weft_sysconf_dir}/default/weftd")
configure_file("${source}/weftd.service.in" "${made}/weftd.service" @ONLY)
file(INSTALL "${made}/weftd.service" DESTINATION "${CMAKE_INSTALL_PREFIX}/lib/systemd/system")
file(INSTALL "${source}/weftd.conf" DESTINATION "${CMAKE_INSTALL_PREFIX}/lib/sysusers.d")
if(NOT EXISTS "$ENV{DESTDIR}${variables}") # what somebody has changed stays
  file(INSTALL "${source}/default" DESTINATION "${weft_sysconf_dir}/default" RENAME weftd)
endif()
