# What the core and its tests are built with. Whatever is missing stops here, with one line and its cure.
# SPDX-License-Identifier: GPL-3.0-or-later

macro(require_package package debian)
	find_package(${package} QUIET ${ARGN})
	if(NOT ${package}_FOUND)
		message(FATAL_ERROR "${package} is missing: apt-get install ${debian}")
	endif()
endmacro()

# An INTERFACE target NAME for a library that is one folder of headers.
function(require_headers name header debian)
	find_path(${name}_INCLUDE_DIR ${header})
	mark_as_advanced(${name}_INCLUDE_DIR)
	if(NOT ${name}_INCLUDE_DIR)
		message(FATAL_ERROR "${name} is missing: apt-get install ${debian}")
	endif()
	add_library(${name} INTERFACE)
	target_include_directories(${name} SYSTEM INTERFACE ${${name}_INCLUDE_DIR})
endfunction()

set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE TRUE)
require_package(Eigen3 libeigen3-dev NO_MODULE)
require_package(nanoflann libnanoflann-dev)
# Boost comes with CGAL, headers only. Exact numbers by it: MeshLab does not bring GMP and MPFR, and their archives do not fit into a plugin.
set(CGAL_DISABLE_GMP ON)
require_package(CGAL libcgal-dev)
require_package(OpenMP g++)
require_headers(xsimd xsimd/xsimd.hpp libxsimd-dev)
require_headers(LBFGSpp LBFGSB.h liblbfgspp-dev)
require_headers(dlib dlib/optimization.h libdlib-dev)
# Debian's dlib is configured for BLAS. Its headers are used alone, and this include guard keeps BLAS out of them.
target_compile_definitions(dlib INTERFACE DLIB_MATRIx_BLAS_BINDINGS_)

if(CURVATURE_LINES_TESTS)
	require_package(GTest libgtest-dev)
	require_package(Qhull libqhull-dev)
endif()
