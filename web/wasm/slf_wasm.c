// SPDX-License-Identifier: Apache-2.0
/* What web/slf.js calls: the C interface with numbers alone. Structs are handed over as arrays of
 * doubles, in the order of the functions below, so that JavaScript knows no offsets. One decode at a
 * time; a failure leaves its text in one place. */
#include <stdint.h>
#include <stdlib.h>

#include "slf/slf.h"

#define EXPORT(name) __attribute__((export_name(#name))) name
#define IMPORT(name) __attribute__((import_module("slf"), import_name(#name)))

IMPORT(read_at) int js_read_at(void* to, double offset, uint32_t bytes);
IMPORT(progress) int js_progress(double fraction);

static slf_error last_error;
static slf_options options;
static double numbers[32];
static slf_range* ranges;

static int read_at(void* user, uint64_t offset, void* to, size_t bytes) {
  (void)user;
  return js_read_at(to, (double)offset, (uint32_t)bytes);
}

static int progress(void* user, double fraction) {
  (void)user;
  return js_progress(fraction);
}

static slf_error* error(void) {
  last_error.size = sizeof last_error;
  return &last_error;
}

void* EXPORT(slfw_alloc)(size_t bytes) { return malloc(bytes); }
void EXPORT(slfw_free)(void* block) { free(block); }
double* EXPORT(slfw_numbers)(void) { return numbers; }

int EXPORT(slfw_code)(void) { return last_error.code; }
double EXPORT(slfw_bit_offset)(void) { return (double)last_error.bit_offset; }
const char* EXPORT(slfw_text)(int which) {
  return which == 0 ? slf_code_name(last_error.code) : which == 1 ? last_error.element
       : which == 2 ? last_error.unit : last_error.message;
}
const char* EXPORT(slfw_version)(void) { return slf_version(); }
uint32_t EXPORT(slfw_format)(void) { return slf_format_version(); }

slf_stream* EXPORT(slfw_open)(const void* bytes, size_t size) {
  slf_stream* stream = NULL;
  slf_open(bytes, size, NULL, &stream, error());
  return stream;
}

slf_stream* EXPORT(slfw_open_reader)(double bytes) {
  slf_reader reader = {sizeof reader, 0, (uint64_t)bytes, NULL, read_at};
  slf_stream* stream = NULL;
  slf_open_reader(&reader, NULL, &stream, error());
  return stream;
}

void EXPORT(slfw_release_stream)(slf_stream* stream) { slf_release_stream(stream); }

/* format version, bytes, points, slices, groups, levels, K, R, normal bits, origin[3], step, metres
 * per unit, up, left-handed, has basis, basis, directions, transfer, gamma min, max, complete, pairs,
 * profile, has index, layers, has splats */
int EXPORT(slfw_info)(const slf_stream* stream) {
  slf_info i = {sizeof i};
  const slf_code code = slf_get_info(stream, &i, error());
  const double all[] = {i.format_version, (double)i.bytes, (double)i.points, i.slices, i.groups,
                        i.levels, i.functions, i.components, i.normal_bits, i.origin[0],
                        i.origin[1], i.origin[2], i.step, i.metres_per_unit, i.up, i.left_handed,
                        i.has_basis, i.basis, i.directions, i.transfer, i.gamma_min, i.gamma_max,
                        i.complete, i.metadata_pairs, i.profile, i.has_index, i.layers,
                        i.has_splats};
  for (size_t k = 0; k < sizeof all / sizeof *all; ++k) numbers[k] = all[k];
  return code;
}

const char* EXPORT(slfw_metadata)(const slf_stream* stream, uint32_t i, int value) {
  const char *key = NULL, *text = NULL;
  slf_get_metadata(stream, i, &key, &text, error());
  return value ? text : key;
}

/* From numbers: levels, groups, max bytes, has region, low[3], high[3], limits: points, memory,
 * work; 1: tell of progress; layers */
void EXPORT(slfw_set_options)(void) {
  const double* n = numbers;
  slf_options o = SLF_OPTIONS_INIT;
  o.levels = (uint32_t)n[0];
  o.groups = (uint32_t)n[1];
  o.max_bytes = (uint64_t)n[2];
  o.has_region = n[3] != 0;
  for (int k = 0; k < 3; ++k) {
    o.region_low[k] = (int32_t)n[4 + k];
    o.region_high[k] = (int32_t)n[7 + k];
  }
  o.max_points = (uint64_t)n[10];
  o.max_memory_bytes = (uint64_t)n[11];
  o.max_work = (uint64_t)n[12];
  if (n[13] != 0) o.progress = progress;
  o.layers = (uint32_t)n[14];
  options = o;
}

/* components, points, bytes to read, of the field, of memory */
int EXPORT(slfw_preflight)(const slf_stream* stream) {
  slf_estimate e = {sizeof e, 0, 0, 0, 0, 0};
  const slf_code code = slf_preflight(stream, &options, &e, error());
  numbers[0] = e.components;
  numbers[1] = (double)e.points;
  numbers[2] = (double)e.read_bytes;
  numbers[3] = (double)e.field_bytes;
  numbers[4] = (double)e.memory_bytes;
  return code;
}

/* How many ranges, or -1; slfw_range puts one in numbers. */
int EXPORT(slfw_ranges)(const slf_stream* stream) {
  size_t count = 0;
  free(ranges);
  ranges = NULL;
  if (slf_get_ranges(stream, &options, NULL, 0, &count, error()) != SLF_OK) return -1;
  ranges = malloc((count + 1) * sizeof *ranges);
  if (ranges == NULL) return -1;
  if (slf_get_ranges(stream, &options, ranges, count, &count, error()) != SLF_OK) return -1;
  return (int)count;
}
void EXPORT(slfw_range)(uint32_t i) {
  numbers[0] = (double)ranges[i].offset;
  numbers[1] = (double)ranges[i].bytes;
}

slf_field* EXPORT(slfw_decode)(const slf_stream* stream) {
  slf_field* field = NULL;
  slf_decode(stream, &options, &field, error());
  return field;
}
void EXPORT(slfw_release_field)(slf_field* field) { slf_release_field(field); }

/* Streams, frame by frame as they come. Options are those set before. */
slf_frames* EXPORT(slfw_frames_open)(void) {
  slf_frames* frames = NULL;
  slf_open_frames(&options, NULL, &frames, error());
  return frames;
}
void EXPORT(slfw_frames_release)(slf_frames* frames) { slf_release_frames(frames); }
int EXPORT(slfw_frames_push)(slf_frames* frames, const void* bytes, size_t size) {
  return slf_frames_push(frames, bytes, size, error());
}
int EXPORT(slfw_frames_finish)(slf_frames* frames) { return slf_frames_finish(frames, error()); }
uint32_t EXPORT(slfw_frames_count)(const slf_frames* frames) {
  return (uint32_t)slf_frames_count(frames);
}
double EXPORT(slfw_frames_held)(const slf_frames* frames) {
  return (double)slf_frames_held_bytes(frames);
}

/* number, time, offset, bytes, predicted, lost, arriving, whether its bytes are held */
int EXPORT(slfw_frame)(const slf_frames* frames, uint32_t place) {
  slf_frame f = {sizeof f};
  const slf_code code = slf_frames_get(frames, place, &f, error());
  const void* bytes = NULL;
  size_t size = 0;
  slf_frames_get_bytes(frames, place, &bytes, &size, NULL);
  const double all[] = {f.number, f.time, (double)f.offset, (double)f.bytes,
                        f.predicted, f.lost, f.arriving, bytes != NULL};
  for (size_t k = 0; k < sizeof all / sizeof *all; ++k) numbers[k] = all[k];
  return code;
}

/* The headers of a frame that is not predicted. */
slf_stream* EXPORT(slfw_frame_headers)(const slf_frames* frames, uint32_t place) {
  const void* bytes = NULL;
  size_t size = 0;
  if (slf_frames_get_bytes(frames, place, &bytes, &size, error()) != SLF_OK) return NULL;
  return slfw_open(bytes, size);
}
slf_field* EXPORT(slfw_frame_decode)(slf_frames* frames, uint32_t place) {
  slf_field* field = NULL;
  slf_frames_decode(frames, place, &field, error());
  return field;
}
int EXPORT(slfw_frames_set_options)(slf_frames* frames) {
  return slf_frames_set_options(frames, &options, error());
}
int EXPORT(slfw_frames_drop_before)(slf_frames* frames, uint32_t place) {
  return slf_frames_drop_before(frames, place, error());
}
int EXPORT(slfw_frames_seek)(slf_frames* frames, uint32_t place) {
  return slf_frames_seek(frames, place, error());
}

/* R, P, levels, partial, origin[3], step, W, directions, transfer, has normals, gamma min, max, has
 * splats */
int EXPORT(slfw_shape)(const slf_field* field) {
  slf_shape s = {sizeof s};
  const slf_code code = slf_get_shape(field, &s, error());
  const double all[] = {s.components, (double)s.points, s.levels, s.partial, s.origin[0],
                        s.origin[1], s.origin[2], s.step, s.weights, s.directions, s.transfer,
                        s.has_normals, s.gamma_min, s.gamma_max, s.has_splats};
  for (size_t k = 0; k < sizeof all / sizeof *all; ++k) numbers[k] = all[k];
  return code;
}

/* Arrays by number, in the order of web/slf.js. */
int EXPORT(slfw_read)(const slf_field* field, int what, uint32_t first, uint32_t count, void* to) {
  switch (what) {
    case 0: return slf_read_positions(field, first, count, to, 0, error());
    case 1: return slf_read_components(field, first, count, to, 0, error());
    case 2: return slf_read_octahedral(field, first, count, to, 0, error());
    case 3: return slf_read_weights(field, first, count, to, 0, error());
    case 4: return slf_read_mean_colours(field, first, count, to, 0, error());
    case 5: return slf_read_mirror_normals(field, first, count, to, 0, error());
    case 6: return slf_read_disc_normals(field, first, count, to, 0, error());
    case 7: return slf_read_disc_centres(field, first, count, to, 0, error());
    case 8: return slf_read_disc_radii(field, first, count, to, 0, error());
    case 9: return slf_read_disc_areas(field, first, count, to, 0, error());
    case 10: return slf_read_splat_covariances(field, first, count, to, 0, error());
    default: return slf_read_splat_opacities(field, first, count, to, 0, error());
  }
}

/* 1 where all values fit 16 bits, which `to` then holds. It may be `from`. */
int EXPORT(slfw_narrow)(const int32_t* from, int16_t* to, uint32_t count) {
  int32_t wide = 0;
  for (uint32_t i = 0; i < count; ++i) wide |= from[i] ^ (int16_t)from[i];
  if (wide != 0) return 0;
  for (uint32_t i = 0; i < count; ++i) to[i] = (int16_t)from[i];
  return 1;
}

int EXPORT(slfw_cube)(const slf_field* field, uint32_t side, float* to, uint32_t floats) {
  return slf_read_function_cube(field, side, to, floats, error());
}

int EXPORT(slfw_radiance)(const slf_field* field, uint32_t count, const uint32_t* points,
                          const float* directions, float* to) {
  return slf_read_radiance(field, count, points, directions, to, error());
}

/* version, then the kernel's constants in the order of slf_kernel */
int EXPORT(slfw_kernel)(void) {
  slf_kernel k = {sizeof k};
  const slf_code code = slf_get_kernel(&k, error());
  const double all[] = {k.version, k.filter_pixels, k.exponent, k.spacing_reach, k.least_reach,
                        k.most_reach, k.smallest, k.core, k.band, k.steepest, k.flattest,
                        k.disc_share, k.density_gain, k.density_offset};
  for (size_t i = 0; i < sizeof all / sizeof *all; ++i) numbers[i] = all[i];
  return code;
}
