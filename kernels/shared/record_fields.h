// The fields of every record that host and device share, for the test that compares how host and device lay them out.
#ifndef UNDERSTORY_RECORD_FIELDS_H
#define UNDERSTORY_RECORD_FIELDS_H
#include "kernels/shared/crown_field.h"
#include "kernels/shared/grid_record.h"
#include "kernels/shared/ground_cover.h"
#include "kernels/shared/records.h"
#include "kernels/shared/tile_occlusion.h"

/// Applies `field(record, name)` to each field, in the order of declaration, and `record(name)` after its last.
#define UNDERSTORY_RECORD_FIELDS(record, field)                                                                     \
  field(LimbPose, to_limb) field(LimbPose, to_scene) field(LimbPose, curvature) field(LimbPose, flutter_amplitude)  \
  field(LimbPose, flutter_phase) field(LimbPose, padding_) record(LimbPose)                                         \
  field(PosedBlock, rest_block) field(PosedBlock, limb_pose) record(PosedBlock)                                     \
  field(TriangleChunk, first_vertex) field(TriangleChunk, first_index) field(TriangleChunk, count)                  \
  field(TriangleChunk, owner) record(TriangleChunk)                                                                 \
  field(BladeUnit, first_triangle) field(BladeUnit, width) field(BladeUnit, pairs) field(BladeUnit, padding_)       \
  record(BladeUnit)                                                                                                 \
  field(FarUnit, first_block) field(FarUnit, first_triangle) record(FarUnit)                                     \
  field(GrassWind, direction_x) field(GrassWind, direction_y) field(GrassWind, slowness)                            \
  field(GrassWind, sample_time) field(GrassWind, series_rate) field(GrassWind, mean_bend)                           \
  field(GrassWind, flutter_amplitude) field(GrassWind, flutter_phase) field(GrassWind, lateral_scale)               \
  field(GrassWind, lateral_delay) field(GrassWind, root_offset_x) field(GrassWind, root_offset_y)                   \
  field(GrassWind, root_offset_z) field(GrassWind, series_count) field(GrassWind, padding_) record(GrassWind)       \
  field(CameraView, right) field(CameraView, down) field(CameraView, forward) field(CameraView, focal)              \
  field(CameraView, centre_x) field(CameraView, centre_y) field(CameraView, near_plane) field(CameraView, width)    \
  field(CameraView, height) field(CameraView, padding_) record(CameraView)                                          \
  field(ShadingSphere, x) field(ShadingSphere, y) field(ShadingSphere, z) field(ShadingSphere, radius)              \
  field(ShadingSphere, opacity) field(ShadingSphere, group) field(ShadingSphere, padding_) record(ShadingSphere)    \
  field(CrownRecord, x) field(CrownRecord, y) field(CrownRecord, z) field(CrownRecord, radius)                      \
  field(CrownRecord, centre_x) field(CrownRecord, centre_y) field(CrownRecord, centre_z)                            \
  field(CrownRecord, alpha_rho) field(CrownRecord, to_unit) field(CrownRecord, volume_scale)                        \
  field(CrownRecord, ambient) field(CrownRecord, extinction) field(CrownRecord, padding_) record(CrownRecord)    \
  field(CrownFieldGrid, low_x) field(CrownFieldGrid, low_y) field(CrownFieldGrid, low_z)                            \
  field(CrownFieldGrid, cells_per_metre) field(CrownFieldGrid, columns) field(CrownFieldGrid, rows)                 \
  field(CrownFieldGrid, layers) field(CrownFieldGrid, first_cell) record(CrownFieldGrid)                            \
  field(GroundCoverGrid, low_x) field(GroundCoverGrid, low_y) field(GroundCoverGrid, cells_per_metre_x)             \
  field(GroundCoverGrid, cells_per_metre_y) field(GroundCoverGrid, columns) field(GroundCoverGrid, rows)            \
  field(GroundCoverGrid, padding_) record(GroundCoverGrid)                                                          \
  field(GridRecord, to_box) field(GridRecord, axes) field(GridRecord, first) field(GridRecord, width)              \
  field(GridRecord, height) field(GridRecord, depth) field(GridRecord, group) field(GridRecord, border)             \
  field(GridRecord, stretch) field(GridRecord, faded_from) field(GridRecord, own_first)                            \
  field(GridRecord, own_size) field(GridRecord, own_scale) field(GridRecord, padding_) record(GridRecord)            \
  field(TileOcclusion, level) field(TileOcclusion, x) field(TileOcclusion, y) field(TileOcclusion, z)               \
  field(TileOcclusion, xx) field(TileOcclusion, yy) field(TileOcclusion, zz) field(TileOcclusion, xy)               \
  field(TileOcclusion, xz) field(TileOcclusion, yz) field(TileOcclusion, distant) field(TileOcclusion, close)       \
  field(TileOcclusion, near) field(TileOcclusion, own) field(TileOcclusion, error) field(TileOcclusion, padding_)   \
  record(TileOcclusion)

#endif
