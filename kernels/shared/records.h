// Records that host and kernels share: fixed width, padded to 16 bytes, a unit on every field.
// Compiles as C++ and as OpenCL C; `probe_records` (tests) checks that both see the same sizes and offsets.
#ifndef UNDERSTORY_RECORDS_H
#define UNDERSTORY_RECORDS_H

#ifdef __OPENCL_C_VERSION__
typedef int record_int;
typedef uint record_uint;
#else
#include <cstdint>
namespace understory {
typedef std::int32_t record_int;
typedef std::uint32_t record_uint;
#endif

/// A limb at time t. A rest point p becomes
///   p += flutter * flutter_amplitude * sin(2 pi (phase/256) + flutter_phase)
///   (s, d, n) = to_limb * (p, 1)          rest metres along the axis, in the bend's direction, across it
///   f = curvature * s;  (s, d) := (s sinc(f) - d sin(f),  s (1 - cos f)/f + d cos f)     circular arc of length s
///   scene = to_scene * (s, d, n, 1)       camera-relative metres, world axes
typedef struct {
  float to_limb[12];        // 3x4, row-major
  float to_scene[12];       // 3x4, row-major
  float curvature;          // 1/m
  float flutter_amplitude;  // rest metres per unit of the raw flutter byte (-127..127); `to_scene` holds the plant's scale
  float flutter_phase;      // radians in [0, 2 pi)
  float padding_[5];
} LimbPose;                 // 128 bytes

/// Which rest block and which limb pose make one block of 16 posed vertices.
typedef struct {
  record_uint rest_block;
  record_uint limb_pose;
} PosedBlock;

/// Up to 256 consecutive triangles of one owner. Triangle ids are chunk * 256 + lane.
/// Mesh: entry `first_index` + lane of the three index planes, plus `first_vertex`.
/// Grass: vertices first_vertex + lane, + 256, + 512; `first_index` + lane is the blade.
typedef struct {
  record_uint first_vertex;
  record_uint first_index;   // mesh: in triangles of the index planes; grass: the first blade
  record_uint count;         // triangles, 1..256
  record_uint owner;         // row of the owner table
} TriangleChunk;             // 16 bytes

/// 16 blades that are drawn, those of lanes first_triangle % 256 + 0..15 of its chunk and of the chunks after it: strips of
/// 2 pairs + 1 vertices. `width`: how much wider they are than at rest.
typedef struct {
  record_uint first_triangle;       // id
  float width;
  record_uint pairs;                // 1, 2 or 3
  record_uint padding_;
} BladeUnit;                        // 16 bytes

/// 16 far leaves or twigs that are drawn, a triangle each: corners a of all of them, then b, then c in three posed blocks.
typedef struct {
  record_uint first_block;          // posed
  record_uint first_triangle;       // id
} FarUnit;

/// The wind over one grass field at time t. Blades look up their own arrival time in the series.
/// Response series: tip-angle response of the field's sway mode, along and across the mean wind, radians at flexibility 1;
/// periodic, `series_count` samples (a power of two), `series_rate` samples per second, linear interpolation.
typedef struct {
  float direction_x, direction_y;   // unit, where the mean wind blows to
  float slowness;                   // 1 / convection speed of the gusts, s/m
  float sample_time;                // t * series_rate reduced modulo series_count, samples
  float series_rate;                // samples per second
  float mean_bend;                  // mean tip angle, radians at flexibility 1
  float flutter_amplitude;          // radians, each blade's own small oscillation
  float flutter_phase;              // radians in [0, 2 pi)
  float lateral_scale;              // m: gust fronts bend sideways over this length
  float lateral_delay;              // s: by so much
  float root_offset_x, root_offset_y, root_offset_z;  // added to blade roots (relative to the origin) to make them camera-relative, m
  record_uint series_count;         // power of two
  float padding_[2];
} GrassWind;                        // 64 bytes

/// Pinhole camera. Axes are unit, world directions; pixel centres at +0.5.
typedef struct {
  float right[4], down[4], forward[4];  // xyz used
  float focal;                          // pixels
  float centre_x, centre_y;             // principal point, pixels
  float near_plane;                     // m
  record_int width, height;             // pixels
  float padding_[2];
} CameraView;                           // 80 bytes

/// A sphere that shades fragments: a crown or a piece of a moving occluder.
typedef struct {
  float x, y, z, radius;    // camera-relative metres
  float opacity;            // share of light its disc blocks, [0, 1]
  record_int group;         // fragments of the same group are not shaded by it
  float padding_[2];
} ShadingSphere;            // 32 bytes

/// The crown that owns a fragment, as the tree methods need it.
typedef struct {
  float x, y, z, radius;          // sphere, camera-relative metres
  float centre_x, centre_y, centre_z;  // ellipsoid centre, camera-relative metres
  float alpha_rho;                // 1/m^3, eq. 6
  float to_unit[12];              // 3x3 rows, ellipsoid to unit sphere, 1/m; fourth in each: square of its radius, m^2
  float volume_scale;             // abc, m^3
  float ambient;                  // A of Reeves and Blau
  float extinction;               // a of Reeves and Blau, 1/m
  float padding_;
} CrownRecord;                    // 96 bytes

#ifndef __OPENCL_C_VERSION__
static_assert(sizeof(LimbPose) == 128 && sizeof(PosedBlock) == 8 && sizeof(TriangleChunk) == 16);
static_assert(sizeof(BladeUnit) == 16 && sizeof(FarUnit) == 8);
static_assert(sizeof(GrassWind) == 64 && sizeof(CameraView) == 80 && sizeof(ShadingSphere) == 32 && sizeof(CrownRecord) == 96);
}  // namespace understory
#endif
#endif
