#define _XOPEN_SOURCE 700 /* mkdtemp */
#include "support/files.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "support/suite.h"

static char folder[256];

void make_folder(void)
{
  const char *temporary = getenv("TMPDIR");
  const int length = snprintf(folder, sizeof folder, "%s/dvi-test-XXXXXX",
                              temporary != NULL ? temporary : P_tmpdir);
  ck_assert_msg(length > 0 && (size_t)length < sizeof folder,
                "TMPDIR is too long a path for the tests");
  ck_assert_ptr_nonnull(mkdtemp(folder));
}

const char *path_in_folder(const char *name)
{
  static char paths[8][320];
  static int next;
  char *path = paths[next++ % 8];
  (void)snprintf(path, sizeof paths[0], "%s/%.60s", folder, name);
  return path;
}

/* Counts the files, and removes them if asked. */
static int visit_files(int removing)
{
  int count = 0;
  DIR *open_folder = opendir(folder);
  ck_assert_ptr_nonnull(open_folder);
  for (const struct dirent *entry = readdir(open_folder); entry != NULL;
       entry = readdir(open_folder)) {
    if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
    if (removing) (void)remove(path_in_folder(entry->d_name));
    count++;
  }
  (void)closedir(open_folder);
  return count;
}

int count_files_in_folder(void)
{
  return visit_files(0);
}

void remove_folder(void)
{
  (void)visit_files(1);
  ck_assert_int_eq(rmdir(folder), 0);
}

bytes read_bytes(const char *path)
{
  enum { MOST = 1 << 20 };
  bytes all = {malloc(MOST), 0};
  FILE *stream = fopen(path, "rb");
  ck_assert_ptr_nonnull(stream);
  ck_assert_ptr_nonnull(all.at);
  all.count = fread(all.at, 1, MOST, stream);
  ck_assert_uint_lt(all.count, MOST);
  (void)fclose(stream);
  return all;
}

void write_bytes(const char *path, const unsigned char *at, size_t count)
{
  FILE *stream = fopen(path, "wb");
  ck_assert_ptr_nonnull(stream);
  ck_assert_uint_eq(fwrite(at, 1, count, stream), count);
  ck_assert_int_eq(fclose(stream), 0);
}

bytes read_state(const dvi_integrator *integrator)
{
  const char *path = path_in_folder("state");
  ck_assert_msg(dvi_integrator_save(integrator, path) == DVI_OK, "%s", dvi_last_error());
  const bytes state = read_bytes(path);
  ck_assert_int_eq(remove(path), 0);
  return state;
}

void check_state(const dvi_integrator *integrator, bytes expected)
{
  const bytes found = read_state(integrator);
  ck_assert_uint_eq(found.count, expected.count);
  ck_assert_msg(memcmp(found.at, expected.at, found.count) == 0, "the states differ at t = %.17g",
                dvi_integrator_time(integrator));
  free(found.at);
  free(expected.at);
}

void check_same_state(const dvi_integrator *a, const dvi_integrator *b)
{
  check_state(a, read_state(b));
}
