# SPDX-License-Identifier: Apache-2.0
# Installs the licences of a component into the folder of documents of its package for Debian. Packages
# are installed one by one, so each has its own.
function(weft_install_licences component package)
  set(folder ${CMAKE_INSTALL_DATAROOTDIR}/doc/${package})
  install(FILES ${CMAKE_SOURCE_DIR}/LICENSE ${CMAKE_SOURCE_DIR}/NOTICE
    DESTINATION ${folder} COMPONENT ${component})
  install(FILES ${CMAKE_SOURCE_DIR}/LICENSE
    DESTINATION ${folder} RENAME copyright COMPONENT ${component})
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/LICENSES DESTINATION ${folder} COMPONENT ${component})
endfunction()
