// A ray of `screen-rays` in the image, and what the pixels that it crosses show. OpenCL only.
#ifndef UNDERSTORY_SCREEN_RAY_H
#define UNDERSTORY_SCREEN_RAY_H

#include "kernels/shared/obscurance_fragments.h"

/// Where steps begin, pixels from the fragment: beyond the pixel that shows it.
#define FIRST_STEP REAL(0.5)
/// Steps are a pixel and, farther away, this share of the way from the fragment.
#define GROWTH REAL(0.2)
/// What is less behind a surface, of a pixel's width there, is on it.
#define ON_SURFACE REAL(0.02)
/// Depths of one surface, seen one after the other, differ by no more, widths of a pixel.
#define JOINED REAL(3.0)
/// The farthest that what a pixel shows is carried along the fragment's plane to the ray, widths of a pixel.
#define CARRIED REAL(16.0)

typedef struct {
  CameraVector end;     // from the fragment, m
  real length;          // m; less than the radius where the camera would be passed
  real step_x, step_y;  // in the image, the longer is a pixel
  real pixels;          // such steps from the fragment to the end
  real inside;          // of them, those in the image
  real widening;        // how large a metre is at the fragment, over at the end
  real jitter;          // where within its steps it looks, [0, 1]
  real turning;         // how much the fragment's plane turns away from what sees it, as `facing`, in a step
  real half_rise;       // of that plane over half a pixel, against both axes of the image
} ScreenRay;

/// Of a share of 2^32 that whole arithmetic went round, [-0.5, 0.5]: all widths and the reference have the same.
SHARED real part_of_turn(bits share) { return TO_REAL(AS_WHOLE(share)) * REAL(2.3283064365386963e-10); }

/// a, b and c along two axes square to the normal, and along it (Duff et al. 2017, "Building an Orthonormal Basis,
/// Revisited", listing 3).
SHARED CameraVector about_normal(Receiver to, real a, real b, real c) {
  const real sign = PICK(to.normal_z < REAL(0.0), REAL(-1.0), REAL(1.0));
  const real over = REAL(-1.0) / (sign + to.normal_z), cross = to.normal_x * to.normal_y * over;
  const real xx = fma(sign * to.normal_x * to.normal_x, over, REAL(1.0));
  const real yy = fma(to.normal_y * to.normal_y, over, sign);
  CameraVector v;
  v.x = fma(a, xx, fma(b, cross, c * to.normal_x));
  v.y = fma(a, sign * cross, fma(b, yy, c * to.normal_y));
  v.z = fma(a, -sign * to.normal_x, fma(-b, to.normal_y, c * to.normal_z));
  return v;
}

/// Steps from the middle of a pixel until one coordinate leaves [0, size). Short of the border by a thousandth: what
/// ends there does not go on by rounding.
SHARED real room(real pixel, real step, int size) {
  const real middle = pixel + REAL(0.5);
  const real way = PICK(step > REAL(0.0), (real)((float)(size)) - middle, middle) - REAL(1e-3);
  return way / at_least(fabs(step), REAL(1e-6));
}

/// The i-th of `count` rays: strata of equal weight from the normal outwards, golden section about it. Pixels of the
/// 4 x 4 pattern have rays of their own.
SHARED ScreenRay screen_ray(Receiver to, Ball ball, Pixels at, uint i, uint count, const ObscuranceSetting* setting) {
  const whole number = at.turn + (whole)((int)(16 * i));
  const real square = (TO_REAL(number) + REAL(0.5)) * (real)(0.0625f / (float)(count));
  const bits turn = (bits)(i * 0x9E3779B9u) + (TO_BITS(at.turn) << 28);  // golden sections, and sixteenths
  const real azimuth = part_of_turn(turn), flat = sqrt(square);
  const CameraVector way =
      about_normal(to, flat * cosine_of_turn(azimuth), flat * sine_of_turn(azimuth), sqrt(REAL(1.0) - square));
  // In front of the camera it ends where a metre is ten times as large as at the fragment.
  const real nearer = -ball.widening * way.z;
  const real share = PICK(nearer > REAL(0.9), REAL(0.9) / nearer, REAL(1.0));
  ScreenRay ray;
  ray.length = (real)(setting->radius) * share;
  ray.end.x = ray.length * way.x;
  ray.end.y = ray.length * way.y;
  ray.end.z = ray.length * way.z;
  ray.widening = fma(-nearer, share, REAL(1.0));
  const real scale = ball.pixels * share / ray.widening;
  const real across = scale * fma(-to.ray_x, way.z, way.x), down = scale * fma(-to.ray_y, way.z, way.y);
  ray.pixels = PICK(fabs(across) > fabs(down), fabs(across), fabs(down));
  const real per_step = REAL(1.0) / at_least(ray.pixels, REAL(1e-6));
  ray.step_x = across * per_step;
  ray.step_y = down * per_step;
  // The second number of the plastic sequence (Roberts 2018, R2) beside the golden section.
  ray.jitter = part_of_turn(TO_BITS(number) * (bits)(0xC13FA9A9u)) + REAL(0.5);
  const real along = fma(to.normal_x, ray.step_x, to.normal_y * ray.step_y);
  ray.inside =
      at_most(at_most(room(at.x, ray.step_x, setting->width), room(at.y, ray.step_y, setting->height)), ray.pixels);
  ray.turning = to.perspective * (real)(1.0f / setting->focal) * along;
  ray.half_rise = REAL(-0.5) * (to.normal_x + to.normal_y);
  return ray;
}

/// The share of the ray's length that its first `pixels` steps are: even in the image is not even in space.
SHARED real share_at(ScreenRay ray, real pixels) { return pixels / fma(ray.widening, ray.pixels - pixels, pixels); }

SHARED real pixel_width(Receiver to, real depth, const ObscuranceSetting* setting) {
  return fma(to.perspective, depth, REAL(1.0) - to.perspective) * (real)(1.0f / setting->focal);
}

/// That the ray crosses after `place` of its steps.
typedef struct {
  whole x, y, index;
  real off_x, off_y;  // the ray from its upper left corner, pixels
} CrossedPixel;

SHARED CrossedPixel crossed_pixel(Pixels at, ScreenRay ray, real place, const ObscuranceSetting* setting) {
  const real last_x = (real)((float)(setting->width - 1)), last_y = (real)((float)(setting->height - 1));
  const real x = fma(ray.step_x, place, at.x + REAL(0.5)), y = fma(ray.step_y, place, at.y + REAL(0.5));
  CrossedPixel pixel;
  pixel.x = TO_WHOLE(at_least(at_most(x, last_x), REAL(0.0)));
  pixel.y = TO_WHOLE(at_least(at_most(y, last_y), REAL(0.0)));
  pixel.index = pixel.y * (whole)(setting->width) + pixel.x;
  pixel.off_x = x - TO_REAL(pixel.x);
  pixel.off_y = y - TO_REAL(pixel.y);
  return pixel;
}

/// What a pixel shows where the ray crosses it.
typedef struct {
  real depth;  // camera z, m; the pixel's own is carried to the ray along the fragment's plane
  real width;  // of a pixel at that depth, m
} SeenPixel;

SHARED SeenPixel seen_pixel(global const float* depth, Pixels at, Receiver to, ScreenRay ray, real place,
                            const ObscuranceSetting* setting) {
  const CrossedPixel pixel = crossed_pixel(at, ray, place, setting);
  const real own = GATHER(real, depth, pixel.index, );
  // Towards the camera along the plane, from the pixel's centre to the ray, widths of a pixel.
  const real rise = fma(to.normal_x, pixel.off_x, fma(to.normal_y, pixel.off_y, ray.half_rise));
  const real slope = rise / at_most(fma(ray.turning, place, to.facing), EDGE_ON);
  SeenPixel seen;
  seen.width = pixel_width(to, own, setting);
  seen.depth = fma(-seen.width, at_least(at_most(slope, CARRIED), -CARRIED), own);
  return seen;
}

/// The surface that a ray is behind, as far as it was crossed.
typedef struct {
  real width;  // m
  real depth;  // of the pixel seen last, m; far outside while there is none
} SurfaceRun;

/// `moved`: steps since the pixel before.
SHARED SurfaceRun next_of_run(SurfaceRun run, truth is_behind, SeenPixel seen, real moved) {
  const truth joined = fabs(seen.depth - run.depth) <= JOINED * seen.width;
  SurfaceRun next;
  next.width = PICK(joined, fma(seen.width, moved, run.width), seen.width);
  next.depth = PICK(is_behind, seen.depth, REAL(-1e30));
  return next;
}

/// From the camera, m. (x, y): pixel.
SHARED CameraVector pixel_point(Receiver to, real x, real y, real depth, const ObscuranceSetting* setting) {
  const real scale = pixel_width(to, depth, setting);
  const CameraVector point = {(x + REAL(0.5) - setting->centre_x) * scale, (y + REAL(0.5) - setting->centre_y) * scale,
                              depth};
  return point;
}

/// Of a ray's length and of depth, m: what is less behind a surface is on it.
SHARED real rounding_of(Receiver to, const ObscuranceSetting* setting) {
  return fma(fabs(to.depth), REAL(4e-6), (real)(5e-4f * setting->radius));
}

/// Of rays that leave the image: whether they end behind the plane of the last pixel that they cross. What is wide goes
/// on beyond the border.
SHARED truth ends_behind(global const float* depth, global const float* normal_x, global const float* normal_y,
                         global const float* normal_z, Pixels at, Receiver to, ScreenRay ray,
                         const ObscuranceSetting* setting) {
  const CrossedPixel last = crossed_pixel(at, ray, ray.inside - REAL(0.5), setting);
  const CameraVector border =
      pixel_point(to, TO_REAL(last.x), TO_REAL(last.y), GATHER(real, depth, last.index, ), setting);
  const CameraVector here = pixel_point(to, at.x, at.y, to.depth, setting);
  const CameraVector normal = in_camera_axes(GATHER(real, normal_x, last.index, ), GATHER(real, normal_y, last.index, ),
                                             GATHER(real, normal_z, last.index, ), setting);
  const real height = fma(here.x + ray.end.x - border.x, normal.x,
                          fma(here.y + ray.end.y - border.y, normal.y, (here.z + ray.end.z - border.z) * normal.z));
  // Background has no plane, whatever its normal, nor has what is behind the camera.
  const real rounding = rounding_of(to, setting), width = pixel_width(to, border.z, setting);
  return (height < -rounding) & (border.z < REAL(1e18)) & (width > REAL(0.0));
}

#endif
