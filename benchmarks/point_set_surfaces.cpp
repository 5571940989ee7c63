// Both point-set surfaces of a cloud ray-traced by turns: seconds of every run, and how far the images agree;
// the projection that no filter offers. For ray_tracing.py, which writes the cloud and reads the JSON object printed.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "curvature_driven_projection.h"
#include "m_weighted_curvature.h"
#include "moving_least_squares.h"
#include "ray_tracing.h"
#include "spatial_order.h"

#include "peers/cloud_file.h"

namespace {

using namespace curvature_lines;

void printList(const char* name, const std::vector<double>& values)
{
	std::printf("\"%s\": [", name);
	for (std::size_t i = 0; i < values.size(); ++i)
		std::printf("%s%.6f", i > 0 ? ", " : "", values[i]);
	std::printf("], ");
}

PreparedCloud readCloud(const char* file)
{
	const CloudFile  given(file);
	const auto       n = static_cast<Eigen::Index>(given.points.size());
	Eigen::Matrix3Xd positions(3, n), normals(3, n);
	for (Eigen::Index i = 0; i < n; ++i)
		for (int c = 0; c < 3; ++c) {
			positions(c, i) = given.points[i][c];
			normals(c, i)   = given.points[i][3 + c];
		}
	return inSpatialOrder(prepareCloud(positions, normals));
}

// The points of a cloud on its own moving-least-squares surface, in no order.
int project(const char* file, const char* output)
{
	const PreparedCloud             prepared = readCloud(file);
	const MovingLeastSquaresSurface surface(CloudIndex(prepared.cloud));
	const Eigen::Matrix3Xd moved = projectPoints(surface, prepared.cloud.positions).positions;
	std::vector<double>    coordinates;
	for (Eigen::Index i = 0; i < moved.cols(); ++i)
		for (const double x : prepared.toModel(moved.col(i)))
			coordinates.push_back(x);
	writeAll(output, coordinates);
	return 0;
}

int compare(const char* file, int width, int height, int runs)
{
	const PreparedCloud             prepared = readCloud(file);
	const CloudIndex                index(prepared.cloud);
	const ControlPoints             control(index);
	const CurvatureDrivenSurface    driven(control);
	const MovingLeastSquaresSurface squares(control);
	RayTracingOptions               options;
	options.width       = width;
	options.height      = height;
	const Camera camera = Camera::facing(prepared.cloud, double(width) / height);

	const PointSetSurface* surfaces[2] = {&driven, &squares};
	std::vector<double>    seconds[2];
	std::vector<RayHit>    hits[2];
	for (int run = 0; run < 2 * runs; ++run) {
		// 0 1 1 0 0 1 ...: each comes first and second alike.
		const int       which = (run + 1) / 2 % 2;
		const RayTracer tracer(*surfaces[which], control, options);
		const Stopwatch watch;
		hits[which] = traceImage(tracer, camera, options);
		seconds[which].push_back(watch.seconds());
	}

	std::size_t seen[2] = {0, 0}, agree = 0, both = 0;
	double      difference = 0.0;
	for (std::size_t p = 0; p < hits[0].size(); ++p) {
		const RayHit &a = hits[0][p], &b = hits[1][p];
		seen[0] += a.exists();
		seen[1] += b.exists();
		agree += a.exists() == b.exists();
		if (a.exists() && b.exists()) {
			++both;
			difference += std::abs(a.depth - b.depth);
		}
	}
	std::printf("{");
	printList("driven", seconds[0]);
	printList("squares", seconds[1]);
	std::printf(
		"\"driven_hits\": %zu, \"squares_hits\": %zu, \"agreement\": %.8f, \"depth_difference\": "
		"%.8f}\n",
		seen[0],
		seen[1],
		double(agree) / double(hits[0].size()),
		difference / double(std::max<std::size_t>(both, 1)) / index.minimum().medianSpacing);
	return 0;
}

// T06 fig. 4: where the weight is largest, by bisection of its slope.
int printPeak(double h, Index exponent)
{
	double low = 0.1 * h, high = 4.0 * h * double(exponent);
	for (int step = 0; step < 100; ++step) {
		const double x = 0.5 * (low + high), d = 1e-6 * h;
		(mWeight(x + d, h, exponent) > mWeight(x - d, h, exponent) ? low : high) = x;
	}
	std::printf("%.17g\n", low);
	return 0;
}

} // namespace

int main(int count, char** words)
{
	try {
		const std::string what = count > 1 ? words[1] : "";
		if (what == "compare" && count == 6)
			return compare(words[2], std::atoi(words[3]), std::atoi(words[4]), std::atoi(words[5]));
		if (what == "project" && count == 4)
			return project(words[2], words[3]);
		if (what == "peak" && count == 4)
			return printPeak(std::atof(words[2]), Index(std::atoi(words[3])));
		std::fprintf(
			stderr,
			"usage: point_set_surfaces compare CLOUD WIDTH HEIGHT RUNS | project CLOUD OUTPUT | "
			"peak H EXPONENT\n");
		return 2;
	}
	catch (const std::exception& error) {
		std::fprintf(stderr, "%s\n", error.what());
		return 1;
	}
}
