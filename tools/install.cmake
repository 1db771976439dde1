# What is installed, and the Debian package: the program, the shipped scenes, the scripts behind `lanewise chart` and
# `lanewise replay`, the man page and the completions of shells.
include(GNUInstallDirs)

# The program tells its own man page and completions. One built for another machine cannot.
find_program(GZIP gzip)
set(LANEWISE_PAGES ${CMAKE_BINARY_DIR}/pages)
set(LANEWISE_PAGE_FILES)
function(lanewise_page kind name)
  set(page ${LANEWISE_PAGES}/${name})
  add_custom_command(OUTPUT ${page}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${LANEWISE_PAGES}
    COMMAND lanewise generate ${kind} > ${page}
    DEPENDS lanewise VERBATIM)
  if(kind STREQUAL "man" AND GZIP)
    add_custom_command(OUTPUT ${page}.gz COMMAND ${GZIP} -9nkf ${page} DEPENDS ${page} VERBATIM)
    set(page ${page}.gz)
  endif()
  set(LANEWISE_PAGE_FILES ${LANEWISE_PAGE_FILES} ${page} PARENT_SCOPE)
  if(NOT CMAKE_CROSSCOMPILING)
    install(FILES ${page} DESTINATION ${ARGN})
  endif()
endfunction()
lanewise_page(man lanewise.1 ${CMAKE_INSTALL_MANDIR}/man1)
lanewise_page(bash lanewise ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
lanewise_page(zsh _lanewise ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
lanewise_page(fish lanewise.fish ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
if(CMAKE_CROSSCOMPILING)
  add_custom_target(lanewise_pages)
else()
  add_custom_target(lanewise_pages ALL DEPENDS ${LANEWISE_PAGE_FILES})
endif()

install(TARGETS lanewise RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
set(LANEWISE_SHARE ${CMAKE_INSTALL_DATADIR}/lanewise)
file(GLOB LANEWISE_SHIPPED CONFIGURE_DEPENDS scenes/*.dae scenes/*.hdr)
install(FILES ${LANEWISE_SHIPPED} scenes/planks.png DESTINATION ${LANEWISE_SHARE}/scenes)

# The two scripts, and the modules of perf/ and perf/peers/ that they import, which import others in turn.
set(wanted perf/chart.py perf/replay.py)
while(wanted)
  list(POP_FRONT wanted script)
  list(APPEND LANEWISE_SCRIPTS ${script})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${script})
  file(STRINGS ${script} imports REGEX "^ *(import|from) ")
  foreach(line IN LISTS imports)
    string(REGEX REPLACE "^ *(import|from) ([a-z0-9_]+).*" "\\2" module "${line}")
    foreach(path perf/${module}.py perf/peers/${module}.py)
      if(EXISTS ${CMAKE_SOURCE_DIR}/${path} AND NOT path IN_LIST LANEWISE_SCRIPTS AND NOT path IN_LIST wanted)
        list(APPEND wanted ${path})
      endif()
    endforeach()
  endforeach()
endwhile()
foreach(script IN LISTS LANEWISE_SCRIPTS)
  get_filename_component(folder ${script} DIRECTORY)
  install(FILES ${script} DESTINATION ${LANEWISE_SHARE}/${folder})
endforeach()
file(GLOB LANEWISE_TOPICS CONFIGURE_DEPENDS perf/replay/*.json)
install(FILES ${LANEWISE_TOPICS} DESTINATION ${LANEWISE_SHARE}/perf/replay)

# Our licence, and those of the libraries of which headers alone are compiled in, as Debian's packages tell them.
file(READ LICENSE LANEWISE_COPYRIGHT)
foreach(package libcli11-dev libglm-dev libhwy-dev libstb-dev nlohmann-json3-dev)
  set(file /usr/share/doc/${package}/copyright)
  if(EXISTS ${file})
    file(READ ${file} text)
    string(APPEND LANEWISE_COPYRIGHT "\n\nThe program holds parts of ${package}:\n\n${text}")
  endif()
endforeach()
file(WRITE ${LANEWISE_PAGES}/copyright "${LANEWISE_COPYRIGHT}")
install(FILES ${LANEWISE_PAGES}/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/lanewise)

file(STRINGS LICENSE LANEWISE_AUTHORS REGEX "^Copyright" LIMIT_COUNT 1)
string(REGEX REPLACE "^Copyright .* [0-9]+ " "" LANEWISE_AUTHORS "${LANEWISE_AUTHORS}")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME lanewise)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT ${LANEWISE_AUTHORS})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "wavefront path tracer for the CPU")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Lanewise renders COLLADA, glTF, OBJ and PLY scenes with diffuse, mirror,
glass and metal surfaces under lights and skies, without bias. Paths pass,
thousands at a time, through small SIMD kernels, compiled for several
instruction sets, of which the program takes the best of the machine it
runs on: AVX-512, AVX2, SSE4, or none beyond those of any x86-64.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3, python3-matplotlib, python3-numpy, python3-pil")  # for chart and replay
include(CPack)
