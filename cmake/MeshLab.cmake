# The host: MeshLab's headers, Qt 5 and an imported meshlab-common out of the unmodified pymeshlab wheel.
# The target meshlab-common carries all three; MESHLAB_VERSION and MESHLAB_SCALAR belong to each plugin.
# SPDX-License-Identifier: GPL-3.0-or-later

require_package(Qt5 "qtbase5-dev libqt5opengl5-dev" COMPONENTS Widgets OpenGL Xml)
require_headers(GLEW GL/glew.h libglew-dev)

# 1. Headers: a folder of the user's, else what scripts/fetch_meshlab_sources.sh finds.
set(MESHLAB_SOURCE_DIR "" CACHE PATH "MeshLab 2025.07 sources with vcglib; fetched when empty")
set(meshlab_sources ${MESHLAB_SOURCE_DIR})
if(NOT meshlab_sources)
	set(meshlab_sources ${PROJECT_SOURCE_DIR}/.cache/meshlab-2025.07)
	execute_process(
		COMMAND ${PROJECT_SOURCE_DIR}/scripts/fetch_meshlab_sources.sh ${meshlab_sources}
		ERROR_VARIABLE problem RESULT_VARIABLE failed)
	if(failed)
		string(REGEX REPLACE "^.*\n([^\n]+)\n$" "\\1" problem "\n${problem}")
		message(FATAL_ERROR "${problem}")
	endif()
endif()
foreach(part src/common/plugins/interfaces/filter_plugin.h src/vcglib/vcg)
	if(NOT EXISTS ${meshlab_sources}/${part})
		message(FATAL_ERROR "MESHLAB_SOURCE_DIR=${meshlab_sources} holds no ${part}: unpack MeshLab 2025.07 with its vcglib there")
	endif()
endforeach()

# 2. The library: in the interpreter that pip builds with, else in the checkout's .venv, else in python3.
if(NOT EXISTS "${MESHLAB_COMMON_LIBRARY}")
	find_program(python3 NAMES python3 NO_CACHE)
	foreach(python ${Python_EXECUTABLE} ${PROJECT_SOURCE_DIR}/.venv/bin/python ${python3})
		# Found, not imported: an import would load the whole of MeshLab.
		execute_process(
			COMMAND ${python} -c "import importlib.util as u; print(u.find_spec('pymeshlab').submodule_search_locations[0])"
			OUTPUT_VARIABLE pymeshlab OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
		if(EXISTS "${pymeshlab}/lib/libmeshlab-common.so")
			set(MESHLAB_COMMON_LIBRARY ${pymeshlab}/lib/libmeshlab-common.so CACHE FILEPATH "The wheel's meshlab-common" FORCE)
			break()
		endif()
	endforeach()
endif()
if(NOT EXISTS "${MESHLAB_COMMON_LIBRARY}")
	message(FATAL_ERROR "libmeshlab-common.so is missing: pip install pymeshlab==2025.7.post1, or pass -DMESHLAB_COMMON_LIBRARY=FILE")
endif()

add_library(meshlab-common SHARED IMPORTED)
set_target_properties(meshlab-common PROPERTIES IMPORTED_LOCATION ${MESHLAB_COMMON_LIBRARY})
target_include_directories(meshlab-common INTERFACE ${meshlab_sources}/src ${meshlab_sources}/src/vcglib)
target_link_libraries(meshlab-common INTERFACE Qt5::Widgets Qt5::OpenGL Qt5::Xml Eigen3::Eigen GLEW)
# The wheel's own Qt and the rest of its libraries are the loading process's business.
target_link_options(meshlab-common INTERFACE -Wl,--allow-shlib-undefined -Wl,--as-needed)
