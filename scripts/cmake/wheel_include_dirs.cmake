# Given to the interface package as CMAKE_PROJECT_INCLUDE. The imported targets of the ROS wheels
# carry an include directory of the machine that built them, /opt/python/..., and CMake refuses an
# include directory that does not exist. This takes it out at the end of the configure step, when
# every target is known. With ROS from apt there is none, and nothing happens.

function(remove_wheel_include_dirs)
  get_directory_property(targets IMPORTED_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(dirs ${target} INTERFACE_INCLUDE_DIRECTORIES)
    if(dirs)
      list(FILTER dirs EXCLUDE REGEX "^/opt/python/")
      set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${dirs}")
    endif()
  endforeach()
endfunction()

cmake_language(DEFER CALL remove_wheel_include_dirs)
