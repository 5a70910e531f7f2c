# Configures a project with Torsion's sources in its tree, by FetchContent and by add_subdirectory. Where
# TORSION_ALL_CASES is set, it also builds and runs it: two minutes on two cores, without optimization.
# usage: cmake -D BUILD=... -D TORSION_SOURCE=... -D SCENE=... -P use_in_tree.cmake
set(place ${BUILD}/in_tree)
file(REMOVE_RECURSE ${place})
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()
foreach(by IN ITEMS FetchContent add_subdirectory)
  run(${CMAKE_COMMAND} -G Ninja -S ${TORSION_SOURCE}/tests/library/consumer_in_tree -B ${place}/${by} -D BY=${by}
    -D TORSION_SOURCE=${TORSION_SOURCE} -D CMAKE_UNITY_BUILD=ON)
endforeach()
if(DEFINED ENV{TORSION_ALL_CASES})
  run(${CMAKE_COMMAND} --build ${place}/FetchContent)
  run(${place}/FetchContent/press_and_twist ${SCENE})
endif()
