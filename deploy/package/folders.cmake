# SPDX-License-Identifier: Apache-2.0
# Folders that depend on the prefix, which is known when it is installed: what Debian has of its own
# in /usr is elsewhere than what is added to a machine by hand.
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(weft_sysconf_dir /etc)
  set(weft_python_dir /usr/lib/python3/dist-packages)
  set(weft_zsh_dir /usr/share/zsh/vendor-completions)
else()
  execute_process(
    COMMAND /usr/bin/python3 -c "import sys; print('%d.%d' % sys.version_info[:2])"
    OUTPUT_VARIABLE python_version OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  set(weft_sysconf_dir "${CMAKE_INSTALL_PREFIX}/etc")
  set(weft_python_dir "${CMAKE_INSTALL_PREFIX}/lib/python${python_version}/dist-packages")
  set(weft_zsh_dir "${CMAKE_INSTALL_PREFIX}/share/zsh/site-functions")
endif()
