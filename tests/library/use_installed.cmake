# Installs the build to a folder and builds the consumer against it, once by find_package and once by pkg-config.
# And the program of docs/library.md.
# usage: cmake -D BUILD=... -D SOURCE=... -D SCENE=... -P use_installed.cmake
set(place ${BUILD}/installed)
file(REMOVE_RECURSE ${place})
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${place}/usr)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${place}/by_cmake -D CMAKE_PREFIX_PATH=${place}/usr)
run(${CMAKE_COMMAND} --build ${place}/by_cmake)
run(${place}/by_cmake/press_and_twist ${SCENE})
run(${place}/by_cmake/press_and_twist_static ${SCENE})

file(GLOB_RECURSE pc ${place}/usr/torsion.pc)
cmake_path(GET pc PARENT_PATH pc_folder)
set(ENV{PKG_CONFIG_PATH} ${pc_folder})
execute_process(COMMAND pkg-config --define-prefix --cflags --libs torsion OUTPUT_VARIABLE flags
  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags)
cmake_path(GET pc_folder PARENT_PATH library_folder)
run(c++ -std=c++20 -Wall -Wextra -Werror ${SOURCE}/press_and_twist.cpp ${flags} -Wl,-rpath,${library_folder}
  -o ${place}/by_pkg_config)
run(${place}/by_pkg_config ${SCENE})

file(READ ${SOURCE}/../../../docs/library.md page)
string(REGEX MATCH "```cpp\n([^`]*)```" block "${page}")
file(WRITE ${place}/page.cpp "${CMAKE_MATCH_1}")
run(c++ -std=c++20 -Wall -Wextra -Werror ${place}/page.cpp ${flags} -Wl,-rpath,${library_folder} -o ${place}/page)
run(${place}/page)
