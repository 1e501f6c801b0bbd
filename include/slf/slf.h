// SPDX-License-Identifier: Apache-2.0
/* The C interface of the decoder: C99, no C++ type, no exception, no global state.
 *
 * A stream is opened (slf_open, slf_open_reader), asked what it holds (slf_get_info, slf_preflight)
 * and decoded (slf_decode) to a field, whose arrays are read into the caller's own memory.
 *
 *     slf_stream* stream = NULL;
 *     slf_field* field = NULL;
 *     slf_error error = SLF_ERROR_INIT;
 *     if (slf_open(bytes, size, NULL, &stream, &error) != SLF_OK ||
 *         slf_decode(stream, NULL, &field, &error) != SLF_OK)
 *       fprintf(stderr, "%s\n", error.message);
 *
 * Structs that have a member `size` grow with versions of the interface: the caller sets it to
 * sizeof of the struct it was compiled with (the SLF_..._INIT macros do), and members beyond it are
 * neither read nor written; inputs count as 0 there. A struct without it stays as it is.
 *
 * Every function that can fail returns an slf_code and fills an slf_error where one is given; what
 * it would have written is then left alone, pointers to be returned are NULL. NULL for an error,
 * for options or for a field that is released is always allowed; any other NULL is
 * SLF_INVALID_ARGUMENT.
 *
 * Threads: functions share nothing but the objects they are given. One stream or one field may be
 * read by several threads at a time, as long as the caller's own callbacks may; a release must be
 * the last use. Integers are bit exact on every platform; floats are not. */
#ifndef SLF_SLF_H
#define SLF_SLF_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32) && defined(SLF_C_SHARED)
#define SLF_API __declspec(dllexport)
#elif defined(__GNUC__)
#define SLF_API __attribute__((visibility("default")))
#else
#define SLF_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- versions ---- */

/* Of this header. Minor: functions, codes and members of sized structs were added; major: a program
 * has to be changed. What is here stays until then: bindings/c/abi.txt has it line by line. */
#define SLF_API_VERSION_MAJOR 1
#define SLF_API_VERSION_MINOR 1

/* Of the library that is linked: SLF_API_VERSION_MAJOR << 16 | SLF_API_VERSION_MINOR. */
SLF_API uint32_t slf_api_version(void);
/* Of the project, "1.2.0". */
SLF_API const char* slf_version(void);
/* The newest format that this library reads: major << 16 | minor. It reads every older one from
 * 1.0 on. */
SLF_API uint32_t slf_format_version(void);

/* Parts of the format that a build may leave out (slf_has_feature: 1 there, 0 left out). */
#define SLF_FEATURE_DRACO 1u   /* geometry coded by Draco */
#define SLF_FEATURE_HEVC 2u    /* components in HEVC pictures */
#define SLF_FEATURE_THREADS 3u /* slf_options.threads has an effect */
SLF_API int slf_has_feature(uint32_t feature);

/* ---- errors ---- */

typedef int32_t slf_code;
enum {
  SLF_OK = 0,
  SLF_NOT_SLF = 1,          /* the signature is missing: another kind of file */
  SLF_TRUNCATED = 2,        /* the stream ends inside a unit */
  SLF_CHECKSUM = 3,         /* a CRC-32 or a digest does not match */
  SLF_OUT_OF_RANGE = 4,     /* a syntax element is outside the range of its clause */
  SLF_RESERVED = 5,         /* a reserved bit or value is in use */
  SLF_UNSUPPORTED = 6,      /* another version, unknown profile, or left out of this build */
  SLF_LIMIT_EXCEEDED = 7,   /* sound, but larger than the limits */
  SLF_INVALID_ARGUMENT = 8, /* of the caller */
  SLF_OUT_OF_MEMORY = 9,
  SLF_CANCELLED = 10,   /* by the caller's progress function */
  SLF_READ_FAILED = 11, /* by the caller's read function */
  SLF_INTERNAL = 12     /* a mistake of the library */
};

/* "SLF_OUT_OF_RANGE"; "SLF_UNKNOWN" for other numbers. A literal. */
SLF_API const char* slf_code_name(slf_code code);

/* What went wrong, and where. Texts are cut to fit and always end with a zero byte. */
typedef struct slf_error {
  uint32_t size; /* sizeof(slf_error) */
  slf_code code;
  uint64_t bit_offset; /* from the first byte of the stream: of the element, or of what holds it
                          (annex F of the specification); 0 where no place is to blame */
  char element[48];    /* the name in the specification's syntax tables, or of the argument */
  char unit[24];       /* type of the unit it is in: "sequence", "geometry", ...; empty: in none */
  char message[168];   /* all of that in a line: "SLF_OUT_OF_RANGE: sps_step in the sequence unit,
                          bit 237" */
} slf_error;
#define SLF_ERROR_INIT \
  { sizeof(slf_error), SLF_OK, 0, "", "", "" }

/* ---- streams ---- */

typedef struct slf_stream slf_stream;

/* What a stream is read through. A reader has to give the same bytes whenever asked. */
typedef struct slf_reader {
  uint32_t size; /* sizeof(slf_reader) */
  uint32_t reserved;
  uint64_t stream_bytes; /* of the whole stream */
  void* user;
  /* Copies `bytes` bytes from `offset` on to `to`; all of them lie within stream_bytes.
   * Returns 0, or anything else: SLF_READ_FAILED. Called by slf_open_reader and slf_decode alone,
   * from the thread that called them. */
  int (*read_at)(void* user, uint64_t offset, void* to, size_t bytes);
} slf_reader;

/* Memory for bytes of a stream that a reader gave, and for the slf_stream and slf_field handles.
 * NOT for what stands behind a handle, which is most: headers and metadata, a field's arrays, and
 * what decoding and the functions that read need inside. That comes from the C++ library's operator
 * new, which a program replaces if it wants to; what a decode takes of both is slf_preflight's
 * memory_bytes. Blocks are given back before slf_release_stream or slf_release_field returns. */
typedef struct slf_allocator {
  uint32_t size; /* sizeof(slf_allocator) */
  uint32_t reserved;
  void* user;
  void* (*allocate)(void* user, size_t bytes); /* aligned as by malloc; NULL: no memory */
  void (*deallocate)(void* user, void* block, size_t bytes);
} slf_allocator;

/* Opens a stream that is in memory, which must stay there until it is released; nothing is copied.
 * Headers and the checksums of all units are verified.
 * allocator: NULL for malloc. Must live as long as the stream and its fields.
 * Errors: those of damaged and of foreign streams, SLF_UNSUPPORTED, SLF_OUT_OF_MEMORY. O(bytes). */
SLF_API slf_code slf_open(const void* bytes, size_t size, const slf_allocator* allocator,
                          slf_stream** stream, slf_error* error);

/* Opens a stream that is read in parts, as they are needed: here its beginning, up to the first
 * unit of geometry; in slf_decode what the options ask for, by the stream's index. Of a stream
 * without an index all is read. *reader is copied. Checksums of parts are verified as they are
 * read. Errors: as slf_open, and SLF_READ_FAILED. */
SLF_API slf_code slf_open_reader(const slf_reader* reader, const slf_allocator* allocator,
                                 slf_stream** stream, slf_error* error);

/* Fields decoded from it stay. */
SLF_API void slf_release_stream(slf_stream* stream);

#define SLF_DIRECTIONS_WORLD 0u
#define SLF_DIRECTIONS_REFLECTED 1u
#define SLF_TRANSFER_DISPLAY 0u
#define SLF_TRANSFER_LINEAR 1u

/* What a stream holds, from its headers alone. */
typedef struct slf_info {
  uint32_t size;           /* sizeof(slf_info) */
  uint32_t format_version; /* major << 16 | minor */
  uint64_t bytes;          /* of the stream */
  uint64_t points;
  uint32_t slices;
  uint32_t groups;     /* of planes: what slf_options.groups counts */
  uint32_t levels;     /* of the octree, the grid's bits: what slf_options.levels counts; 1 .. 21 */
  uint32_t functions;  /* K, 0 .. 4096 */
  uint32_t components; /* R, the coded ones */
  uint32_t normal_bits;   /* of coded normals; 0: none */
  double origin[3];       /* world position of voxel (0, 0, 0) */
  double step;            /* world units from voxel to voxel */
  double metres_per_unit; /* 0: not known */
  uint32_t up;            /* 0 .. 6: +x -x +y -y +z -z unknown */
  uint32_t left_handed;
  uint32_t has_basis;          /* 0: planes without a meaning; no radiance, no colours */
  uint32_t basis;              /* 0: B-splines, 1: spherical harmonics */
  uint32_t directions;         /* SLF_DIRECTIONS_... */
  uint32_t transfer;           /* SLF_TRANSFER_... */
  double gamma_min, gamma_max; /* directions are clamped to these, -1 .. 1 */
  uint32_t complete;           /* 0: cut short, the end is missing */
  uint32_t metadata_pairs;     /* slf_get_metadata; of slf_open_reader those before the geometry:
                                  most files have theirs at the end, and slf_open sees these */
  uint32_t profile;            /* 0 main, 1 Draco geometry, 2 texture */
  uint32_t has_index;          /* parts can be read without the rest */
  uint32_t layers;             /* of the group that has most: what slf_options.layers counts */
  uint32_t has_splats;         /* points are Gaussian splats (spec 6.8), and drawn as those: E.6 */
} slf_info;

SLF_API slf_code slf_get_info(const slf_stream* stream, slf_info* info, slf_error* error);

/* Pair i < slf_info.metadata_pairs, UTF-8, zero at the end. Pointers live as long as the stream. */
SLF_API slf_code slf_get_metadata(const slf_stream* stream, uint32_t i, const char** key,
                                  const char** value, slf_error* error);

/* ---- decoding ---- */

typedef struct slf_options {
  uint32_t size; /* sizeof(slf_options) */
  uint32_t
      levels; /* of the octree to keep, 1 .. slf_info.levels; 0: all. Fewer give a coarser grid */
  uint32_t groups;     /* to decode, 1 .. slf_info.groups; 0: all */
  int32_t threads;     /* 0: one; below 0: all cores. The result does not depend on it */
  uint64_t max_bytes;  /* only units that end within the first max_bytes of the stream; 0: all. Of a
                          stream that is read in parts nothing behind them is read */
  uint32_t has_region; /* 1: only points whose voxel of the kept levels meets the box */
  int32_t region_low[3], region_high[3]; /* voxels of the whole grid, both included */
  uint32_t layers;                       /* of quality to decode, 1 .. slf_info.layers; 0: all */
  /* Limits. Refused beyond these, before anything that large is allocated; 0: the default. */
  uint64_t max_stream_bytes; /* 2^32 */
  uint64_t max_points;       /* 2^26 */
  uint64_t max_planes;       /* 12288 */
  uint64_t max_memory_bytes; /* 2^30: slf_preflight's memory_bytes, and what the library counts */
  uint64_t max_work;         /* 2^35: decisions and values */
  /* Called between the units of a stream by one thread at a time, which need not be the caller's;
   * fraction: 0 .. 1 of the bytes to decode. Anything but 0 ends the decode with SLF_CANCELLED.
   * NULL: not called. */
  int (*progress)(void* user, double fraction);
  void* user;
} slf_options;
#define SLF_OPTIONS_INIT \
  { sizeof(slf_options), 0, 0, 0, 0, 0, {0, 0, 0}, {0, 0, 0}, 0, 0, 0, 0, 0, 0, NULL, NULL }

/* What slf_decode with these options will give and take; nothing is decoded. */
typedef struct slf_estimate {
  uint32_t size;         /* sizeof(slf_estimate) */
  uint32_t components;   /* R */
  uint64_t points;       /* at most; of fewer levels or a region it is not known before */
  uint64_t read_bytes;   /* of the stream */
  uint64_t field_bytes;  /* memory of the field at most */
  uint64_t memory_bytes; /* the most that decoding needs at a time: the field, what it takes beside,
                            and what was read of the stream through a reader */
} slf_estimate;

SLF_API slf_code slf_preflight(const slf_stream* stream, const slf_options* options,
                               slf_estimate* estimate, slf_error* error);

/* Runs of bytes of the stream that slf_decode with these options reads through a reader, ascending,
 * those next to each other joined; what was read when the stream was opened is not among them.
 * ranges: [capacity] receives the first ones; *count: how many there are. NULL with capacity 0 asks
 * for their number. A stream in memory has none. An slf_range stays as it is, since arrays are made
 * of it. */
typedef struct slf_range {
  uint64_t offset, bytes;
} slf_range;
SLF_API slf_code slf_get_ranges(const slf_stream* stream, const slf_options* options,
                                slf_range* ranges, size_t capacity, size_t* count,
                                slf_error* error);

typedef struct slf_field slf_field;

/* Decodes. A stream cut between units gives a field that is marked partial; other damage gives
 * nothing. options: NULL for all of it with the default limits.
 * Errors: as slf_open, SLF_LIMIT_EXCEEDED, SLF_INVALID_ARGUMENT (levels, groups or layers beyond
 * what there is), SLF_CANCELLED, SLF_READ_FAILED, SLF_OUT_OF_MEMORY. O(points * components). */
SLF_API slf_code slf_decode(const slf_stream* stream, const slf_options* options, slf_field** field,
                            slf_error* error);
SLF_API void slf_release_field(slf_field* field);

/* ---- frames ---- */

/* A light field that moves is a stream of frames (spec 7.13), which slf_open shows the first of;
 * one that does not move is one frame. Here their bytes are pushed as they come, and frames are
 * pulled:
 *
 *     slf_open_frames(NULL, NULL, &frames, &error);
 *     while ((size = read(file, bytes, sizeof bytes)) > 0) {
 *       slf_frames_push(frames, bytes, size, &error);
 *       for (; place < slf_frames_count(frames); ++place)
 *         if (slf_frames_decode(frames, place, &field, &error) == SLF_OK) show(field);
 *     }
 *     slf_frames_finish(frames, &error);  // and what is left of them
 *
 * A place is that of a frame in the list, from 0. A light field that does not move can be pulled
 * before it is whole, as soon as its headers have come: slf_frames_get of place 0 gives a frame
 * that is `arriving`, slf_frames_decode what the units that have come allow, each time from the
 * beginning, and slf_frames_count counts it when the last has. One thread at a time may use an
 * slf_frames; the fields that it gives are as any others, and outlive it. */
typedef struct slf_frames slf_frames;

typedef struct slf_frame {
  uint32_t size;   /* sizeof(slf_frame) */
  uint32_t number; /* ascending */
  double time;     /* seconds, ascending */
  uint64_t offset; /* of its first byte in the stream */
  uint64_t bytes;
  uint32_t predicted; /* 1: from the frame before it */
  uint32_t lost;      /* 1: no frame could be read here, and slf_frames_decode says why; it stands
                         for one or several, its number is that of the last of them */
  uint32_t arriving;  /* 1: it does not move, and its end unit has not come: `bytes` are those of
                         units that have */
} slf_frame;

/* options: of every frame; NULL: all of it with the default limits. They are copied, `user` stays
 * the caller's. max_bytes has to be 0; max_stream_bytes limits what is held at a time; a region is
 * cut from frames decoded whole. allocator: of the handle and of those of fields, as in slf_open.
 * Errors: SLF_INVALID_ARGUMENT, SLF_OUT_OF_MEMORY. */
SLF_API slf_code slf_open_frames(const slf_options* options, const slf_allocator* allocator,
                                 slf_frames** frames, slf_error* error);
/* Fields decoded from it stay. */
SLF_API void slf_release_frames(slf_frames* frames);

/* Copies the bytes that follow those of the call before. O(size), and none is decoded.
 * Errors: SLF_NOT_SLF, those of the first frame's headers and of the units of a light field that
 * does not move, for good; SLF_LIMIT_EXCEEDED: nothing was taken, and can be after
 * slf_frames_drop_before; SLF_INVALID_ARGUMENT after the end. */
SLF_API slf_code slf_frames_push(slf_frames* frames, const void* bytes, size_t size,
                                 slf_error* error);
/* The stream ends here. Lists a last frame that was cut short, and the one frame of a light field
 * that does not move. Errors: those of slf_frames_push; SLF_TRUNCATED: no frame began, or one that
 * does not move ends inside a unit. */
SLF_API slf_code slf_frames_finish(slf_frames* frames, slf_error* error);

/* Frames that have arrived whole, dropped ones too. NULL: 0. O(1). */
SLF_API size_t slf_frames_count(const slf_frames* frames);
/* Memory that bytes of the stream take. NULL: 0. O(1). */
SLF_API uint64_t slf_frames_held_bytes(const slf_frames* frames);
/* Errors: SLF_INVALID_ARGUMENT "place". O(1). */
SLF_API slf_code slf_frames_get(const slf_frames* frames, size_t place, slf_frame* frame,
                                slf_error* error);
/* The bytes of a frame, until they are dropped, those of one that is arriving until more are
 * pushed; those of one that is not predicted are what slf_open takes: headers, metadata,
 * slf_preflight. Errors: SLF_READ_FAILED: they were dropped. O(1). */
SLF_API slf_code slf_frames_get_bytes(const slf_frames* frames, size_t place, const void** bytes,
                                      size_t* size, slf_error* error);

/* Decodes any frame of the list. A predicted one costs the decode of those before it, back to one
 * that is not or to the one decoded last: in order each frame is decoded once.
 * Errors: as slf_decode; those of a frame that it is predicted from: frames that follow in its
 * group fail as well, those from the next one on that is not predicted do not. SLF_READ_FAILED:
 * bytes of its group were dropped. O(points * components) a frame. */
SLF_API slf_code slf_frames_decode(slf_frames* frames, size_t place, slf_field** field,
                                   slf_error* error);

/* As slf_open_frames, for frames that are decoded from here on: the next that is predicted is
 * decoded from the frame on that its group begins with. Errors: SLF_INVALID_ARGUMENT. */
SLF_API slf_code slf_frames_set_options(slf_frames* frames, const slf_options* options,
                                        slf_error* error);

/* Drops the bytes of groups before that of `place`: a group is a frame that is not predicted and
 * those that go back to it. */
SLF_API slf_code slf_frames_drop_before(slf_frames* frames, size_t place, slf_error* error);
/* The bytes pushed next are those from slf_frame.offset of `place` on, which is a frame that is not
 * predicted. All that is held is dropped. Errors: SLF_INVALID_ARGUMENT "place". */
SLF_API slf_code slf_frames_seek(slf_frames* frames, size_t place, slf_error* error);

/* ---- fields ---- */

typedef struct slf_shape {
  uint32_t size;       /* sizeof(slf_shape) */
  uint32_t components; /* R: integers of a point are [R][3] */
  uint64_t points;     /* P */
  uint32_t levels;     /* bits of the grid of these points */
  uint32_t partial;    /* 1: less than the stream was made of; what is missing counts as zero */
  double origin[3];    /* of the grid of these points, as in slf_info */
  double step;
  uint32_t weights;     /* W: real weights of a point are [W][3]; R, or K with a joint transform; 0
                           without a basis */
  uint32_t directions;  /* SLF_DIRECTIONS_... */
  uint32_t transfer;    /* SLF_TRANSFER_... */
  uint32_t has_normals; /* coded ones */
  double gamma_min, gamma_max;
  uint32_t has_splats; /* 1: slf_read_splat_..., and drawn by annex E.6, not E.1 to E.5 */
} slf_shape;
SLF_API slf_code slf_get_shape(const slf_field* field, slf_shape* shape, slf_error* error);

/* Arrays are read for points first .. first + count - 1 to `to`, row p at p * stride bytes (stride
 * 0: rows are packed). Points are in Morton order, x least significant. Errors:
 * SLF_INVALID_ARGUMENT "first", "stride" (shorter than a row), or the name of the array where the
 * field has none; SLF_OUT_OF_MEMORY where something has to be worked out first. */

/* uint32[3]: voxels x, y, z, 0 .. 2^levels - 1. */
SLF_API slf_code slf_read_positions(const slf_field* field, uint64_t first, uint64_t count,
                                    uint32_t* to, size_t stride, slf_error* error);
/* int32[R][3]: the integers of the bit exact decode. */
SLF_API slf_code slf_read_components(const slf_field* field, uint64_t first, uint64_t count,
                                     int32_t* to, size_t stride, slf_error* error);
/* uint16[2]: coded normals as levels of the octahedral map, slf_info.normal_bits each. */
SLF_API slf_code slf_read_octahedral(const slf_field* field, uint64_t first, uint64_t count,
                                     uint16_t* to, size_t stride, slf_error* error);
/* float[W][3]: weights in R, G, B of the functions of slf_read_functions: the radiance of a point
 * along a direction is the sum of weights times functions, clamped to 0 .. 255. */
SLF_API slf_code slf_read_weights(const slf_field* field, uint64_t first, uint64_t count, float* to,
                                  size_t stride, slf_error* error);
/* uint8[3]: R, G, B averaged over all directions, of the field's transfer. */
SLF_API slf_code slf_read_mean_colours(const slf_field* field, uint64_t first, uint64_t count,
                                       uint8_t* to, size_t stride, slf_error* error);
/* float[3]: unit normals that directions are mirrored at, of either sign. Of
 * SLF_DIRECTIONS_REFLECTED. */
SLF_API slf_code slf_read_mirror_normals(const slf_field* field, uint64_t first, uint64_t count,
                                         float* to, size_t stride, slf_error* error);

/* The discs that a renderer draws (spec annex E.2). Worked out for the whole field, once, when
 * first asked for: some microseconds a point. float[3]: unit normal, of either sign: coded, else
 * estimated; 0 where it has none and faces the eye. */
SLF_API slf_code slf_read_disc_normals(const slf_field* field, uint64_t first, uint64_t count,
                                       float* to, size_t stride, slf_error* error);
/* float[3]: centre, voxels of the field's grid: world = origin + step * centre. */
SLF_API slf_code slf_read_disc_centres(const slf_field* field, uint64_t first, uint64_t count,
                                       float* to, size_t stride, slf_error* error);
/* float: radius R, world units. */
SLF_API slf_code slf_read_disc_radii(const slf_field* field, uint64_t first, uint64_t count,
                                     float* to, size_t stride, slf_error* error);
/* float: s^2, the area of the surface that a point stands for, world units squared. */
SLF_API slf_code slf_read_disc_areas(const slf_field* field, uint64_t first, uint64_t count,
                                     float* to, size_t stride, slf_error* error);

/* Gaussian splats (spec 6.8; slf_shape.has_splats). Worked out for the whole field, once, when
 * first asked for. float[6]: covariance xx, xy, xz, yy, yz, zz about the point's place, world units
 * squared; what does not fit a float is infinite or no number, and such a splat is not drawn. */
SLF_API slf_code slf_read_splat_covariances(const slf_field* field, uint64_t first, uint64_t count,
                                            float* to, size_t stride, slf_error* error);
/* float: share of what is behind it that a splat hides at its centre, 0 .. 1. */
SLF_API slf_code slf_read_splat_opacities(const slf_field* field, uint64_t first, uint64_t count,
                                          float* to, size_t stride, slf_error* error);

/* The W functions of direction along `directions` (float[count][3], of any length > 0; local
 * to the points: slf_local_direction), gamma clamped to the field's range.
 * to: float[count][W], rows `stride` bytes apart. */
SLF_API slf_code slf_read_functions(const slf_field* field, uint64_t count, const float* directions,
                                    float* to, size_t stride, slf_error* error);

/* The same on the faces of a cube, for textures: functions in layers of four, the last filled up
 * with zeros. side: texels along an edge, 2 .. 1024; the outermost ones stand on the edges, texel i
 * at -1 + 2 i / (side - 1), so that linear interpolation within a face reaches all of it. Faces are
 * +x -x +y -y +z -z with (s, t) as in OpenGL's cube maps: column along s, row along t.
 * to: float[ceil(W / 4)][6][side][side][4]; capacity: floats there is room for. */
SLF_API slf_code slf_read_function_cube(const slf_field* field, uint32_t side, float* to,
                                        size_t capacity, slf_error* error);

/* Direction `world` (float[3], from a point to the eye, any length > 0) as the functions of point p
 * take it: of unit length, mirrored at the point's normal where slf_shape.directions says so.
 * Errors: SLF_INVALID_ARGUMENT, also for a direction of length 0, or one that is not finite. */
SLF_API slf_code slf_local_direction(const slf_field* field, uint64_t p, const float* world,
                                     float* to, slf_error* error);

/* Colours of `count` points: points[i] seen along directions[3 i ..] (from the point to the eye,
 * any length > 0). to: float[count][3], R, G, B, 0 .. 255 of the field's transfer. Spec 6.7.
 * Errors: as slf_local_direction, before anything is written. */
SLF_API slf_code slf_read_radiance(const slf_field* field, uint64_t count, const uint32_t* points,
                                   const float* directions, float* to, slf_error* error);

/* The constants of the reference reconstruction, by the names of spec annex E. */
typedef struct slf_kernel {
  uint32_t size; /* sizeof(slf_kernel) */
  int32_t version;
  double filter_pixels, exponent, spacing_reach, least_reach, most_reach, smallest, core, band,
      steepest, flattest, disc_share, density_gain, density_offset;
} slf_kernel;
SLF_API slf_code slf_get_kernel(slf_kernel* kernel, slf_error* error);

#ifdef __cplusplus
}
#endif

#endif
