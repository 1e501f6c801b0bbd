// SPDX-License-Identifier: Apache-2.0
/* A program in C99 on slf/slf.h alone: every file named is opened and decoded twenty times, from
 * memory and through a reader; all that is taken of an allocator is given back; no struct that is
 * shorter than the library's is read or written beyond its end.
 *   c_program decodes|refuses FILE ... */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "slf/slf.h"

#ifndef SLF_ROUNDS
#define SLF_ROUNDS 20
#endif

static size_t blocks = 0, fail_after = (size_t)-1;

static void* allocate(void* user, size_t bytes) {
  (void)user;
  if (fail_after == 0) return NULL;
  --fail_after;
  ++blocks;
  return malloc(bytes);
}

static void deallocate(void* user, void* block, size_t bytes) {
  (void)user;
  (void)bytes;
  --blocks;
  free(block);
}

static const slf_allocator counting = {sizeof(slf_allocator), 0, NULL, allocate, deallocate};

static int failures = 0;

static void expect(int holds, const char* what, const char* file) {
  if (holds) return;
  printf("%s: %s\n", file, what);
  ++failures;
}

struct file {
  const char* name;
  unsigned char* bytes;
  size_t size;
};

static int read_at(void* user, uint64_t offset, void* to, size_t bytes) {
  const struct file* file = user;
  if (offset > file->size || bytes > file->size - offset) return 1;
  memcpy(to, file->bytes + offset, bytes);
  return 0;
}

static struct file load(const char* name) {
  struct file file = {NULL, NULL, 0};
  FILE* in = fopen(name, "rb");
  file.name = name;
  if (in == NULL) return file;
  fseek(in, 0, SEEK_END);
  file.size = (size_t)ftell(in);
  rewind(in);
  file.bytes = malloc(file.size + 1);
  file.size = fread(file.bytes, 1, file.size, in);
  fclose(in);
  return file;
}

/* A sum over all integers of a field, so that they are all read. */
static uint64_t sum_of(const slf_field* field, const char* name) {
  slf_shape shape = {sizeof(slf_shape), 0, 0, 0, 0, {0, 0, 0}, 0, 0, 0, 0, 0, 0, 0, 0};
  uint64_t sum = 0, i;
  int32_t* values;
  expect(slf_get_shape(field, &shape, NULL) == SLF_OK, "no shape", name);
  values = malloc((size_t)shape.points * shape.components * 12 + 1);
  expect(slf_read_components(field, 0, shape.points, values, 0, NULL) == SLF_OK, "no components", name);
  for (i = 0; i < shape.points * shape.components * 3; ++i) sum = sum * 31 + (uint32_t)values[i];
  free(values);
  return sum + shape.points;
}

static slf_code decode_once(const struct file* file, int through_reader, uint64_t* sum) {
  slf_error error = SLF_ERROR_INIT;
  slf_stream* stream = NULL;
  slf_field* field = NULL;
  slf_reader reader = {sizeof(slf_reader), 0, 0, NULL, NULL};
  slf_code code;
  reader.stream_bytes = file->size;
  reader.user = (void*)file;
  reader.read_at = read_at;
  code = through_reader ? slf_open_reader(&reader, &counting, &stream, &error)
                        : slf_open(file->bytes, file->size, &counting, &stream, &error);
  if (code == SLF_OK) code = slf_decode(stream, NULL, &field, &error);
  expect((code == SLF_OK) == (field != NULL), "a field and a code that disagree", file->name);
  expect(error.code == code, "the error has another code", file->name);
  expect(code == SLF_OK || strstr(error.message, error.element) != NULL, "a message without its element", file->name);
  slf_release_stream(stream);
  if (field != NULL) *sum = sum_of(field, file->name);
  slf_release_field(field);
  expect(blocks == 0, "blocks were not given back", file->name);
  return code;
}

/* A struct of an older header: what lies behind its size stays as it is. */
static void check_growth(const struct file* file) {
  unsigned char bytes[sizeof(slf_info)];
  slf_info* info = malloc(sizeof *info);
  slf_stream* stream = NULL;
  size_t i;
  if (slf_open(file->bytes, file->size, NULL, &stream, NULL) != SLF_OK) {
    free(info);
    return;
  }
  memset(info, 0xA5, sizeof *info);
  info->size = 24; /* up to points */
  expect(slf_get_info(stream, info, NULL) == SLF_OK, "no info", file->name);
  memcpy(bytes, info, sizeof bytes);
  expect(info->bytes == file->size, "bytes", file->name);
  for (i = 24; i < sizeof bytes; ++i) expect(bytes[i] == 0xA5, "written beyond the size of a struct", file->name);
  slf_release_stream(stream);
  free(info);
}

/* Options of an older header: limits behind their size are not read. */
static void check_older_options(const struct file* file) {
  slf_options options = SLF_OPTIONS_INIT;
  slf_stream* stream = NULL;
  slf_field* field = NULL;
  if (slf_open(file->bytes, file->size, NULL, &stream, NULL) != SLF_OK) return;
  options.max_stream_bytes = 1;
  expect(slf_decode(stream, &options, &field, NULL) == SLF_LIMIT_EXCEEDED, "a limit was not held", file->name);
  options.size = offsetof(slf_options, max_stream_bytes);
  expect(slf_decode(stream, &options, &field, NULL) == SLF_OK, "read beyond the size of a struct", file->name);
  slf_release_field(field);
  slf_release_stream(stream);
}

/* Without memory from the allocator there is an error, and nothing is kept. */
static void check_no_memory(const struct file* file) {
  uint64_t sum = 0;
  size_t count;
  for (count = 0; count < 2; ++count) {
    fail_after = count;
    expect(decode_once(file, 0, &sum) == SLF_OUT_OF_MEMORY, "decoded without memory", file->name);
  }
  fail_after = (size_t)-1;
}

int main(int argc, char** argv) {
  const int decodes = argc > 1 && strcmp(argv[1], "decodes") == 0;
  int i, round;
  if (argc < 3) return 2;
  for (i = 2; i < argc; ++i) {
    const struct file file = load(argv[i]);
    uint64_t first = 0, sum = 0;
    expect(file.bytes != NULL, "cannot be read", argv[i]);
    if (file.bytes == NULL) continue;
    for (round = 0; round < SLF_ROUNDS; ++round) {
      const slf_code code = decode_once(&file, round % 2, &sum);
      expect(decodes == (code == SLF_OK), decodes ? "was refused" : "was decoded", argv[i]);
      if (round == 0) first = sum;
      expect(sum == first, "another field", argv[i]);
    }
    if (decodes) {
      check_growth(&file);
      check_older_options(&file);
      check_no_memory(&file);
    }
    free(file.bytes);
  }
  printf("%d files, %d failures\n", argc - 2, failures);
  return failures == 0 ? 0 : 1;
}
