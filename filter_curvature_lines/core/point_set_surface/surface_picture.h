// Pictures of a ray-traced surface: shading, smooth outlines, and lines drawn on the surface.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "control_neighborhood.h"
#include "point_cloud.h"
#include "progress.h"
#include "ray_tracing.h"

namespace curvature_lines {

struct PictureOptions {
	RayTracingOptions image;
	Eigen::Vector3d   background = {1.0, 1.0, 1.0}; // 0..1
	// four rays more where neighbouring pixels differ
	bool   smoothOutlines = true;
	double lineWidth      = 1.4; // pixels
};

// Lines on the surface, each with one colour (0..1).
struct PictureLines {
	Eigen::Matrix3Xd                     vertices; // 3 x M
	std::vector<std::pair<Index, Index>> segments;
	Eigen::Matrix3Xd                     colors; // 3 x segments
};

struct Picture {
	int                       width = 0, height = 0;
	std::vector<std::uint8_t> rgb;      // 3 bytes per pixel, row by row from the top
	Index                     hits = 0; // pixels that show the surface
};

// `colors`: of the control points (3 x N, 0..1), blended between them. Lines are hidden behind the surface.
Picture renderPicture(
	const RayTracer&        tracer,
	const ControlPoints&    control,
	const Eigen::Matrix3Xd& colors,
	const PictureLines&     lines,
	const Camera&           camera,
	const PictureOptions&   options,
	const Progress&         progress = {});

} // namespace curvature_lines
