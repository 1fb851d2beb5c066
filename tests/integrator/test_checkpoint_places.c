/* labels: unit */
/* Checkpoints go to places that can be written, through links, and change nothing else. */
#define _POSIX_C_SOURCE 200809L /* geteuid, RLIMIT_FSIZE */
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/files.h"
#include "support/runs.h"
#include "support/suite.h"
#include "mid_run.h"

static void not_written(const dvi_integrator *integrator, const char *path, const char *words)
{
  ck_assert_int_eq(dvi_integrator_save(integrator, path), DVI_IO_ERROR);
  check_words(words);
}

START_TEST(a_place_that_cannot_be_written_is_reported)
{
  enum { TOO_LONG = 10000 };
  static char endless[TOO_LONG];
  scene s = create_scene();
  const char *full = path_in_folder("full");
  memset(endless, 'x', TOO_LONG - 1);
  not_written(s.integrator, path_in_folder("missing/file"), "No such file");
  not_written(s.integrator, endless, "too long");
  not_written(s.integrator, "", "cannot write");
  write_bytes(path_in_folder("file"), s.past.at, 1);
  not_written(s.integrator, path_in_folder("file/inside"), "Not a directory");
  ck_assert_int_eq(mkdir(full, 0700), 0);
  not_written(s.integrator, full, "not a regular file");
  ck_assert_int_eq(count_files_in_folder(), 2);
  if (geteuid() != 0) { /* root may write anywhere */
    ck_assert_int_eq(chmod(full, 0500), 0);
    not_written(s.integrator, path_in_folder("full/file"), "Permission denied");
  }
  clear_scene(&s);
}
END_TEST

START_TEST(a_link_is_followed_and_stays)
{
  scene s = create_scene();
  struct stat about;
  write_bytes(path_in_folder("target"), s.past.at, 1);
  ck_assert_int_eq(symlink("target", path_in_folder("link")), 0);
  ck_assert_int_eq(dvi_integrator_save(s.integrator, path_in_folder("link")), DVI_OK);
  ck_assert_int_eq(lstat(path_in_folder("link"), &about), 0);
  ck_assert(S_ISLNK(about.st_mode));
  ck_assert_int_eq(dvi_integrator_restore(s.integrator, path_in_folder("target")), DVI_OK);
  clear_scene(&s);
}
END_TEST

START_TEST(a_pipe_is_no_place_for_a_checkpoint)
{
  scene s = create_scene();
  struct stat about;
  ck_assert_int_eq(mkfifo(path_in_folder("pipe"), 0600), 0);
  not_written(s.integrator, path_in_folder("pipe"), "not a regular file");
  ck_assert_int_eq(stat(path_in_folder("pipe"), &about), 0);
  ck_assert(S_ISFIFO(about.st_mode));
  clear_scene(&s);
}
END_TEST

START_TEST(neither_neighbours_nor_the_file_s_rights_change)
{
  scene s = create_scene();
  struct stat about;
  write_bytes(path_in_folder("w.part"), s.past.at, 3);
  write_bytes(path_in_folder("w"), s.past.at, 3);
  ck_assert_int_eq(chmod(path_in_folder("w"), 0600), 0);
  ck_assert_int_eq(dvi_integrator_save(s.integrator, path_in_folder("w")), DVI_OK);
  ck_assert_int_eq(stat(path_in_folder("w"), &about), 0);
  ck_assert_int_eq(about.st_mode & 0777, 0600);
  ck_assert_int_eq(stat(path_in_folder("w.part"), &about), 0);
  ck_assert_int_eq(about.st_size, 3);
  ck_assert_int_eq(count_files_in_folder(), 2);
  clear_scene(&s);
}
END_TEST

/* A limit on the size of files stands for the full disk, so writing stops in mid-file. */
START_TEST(a_full_disk_leaves_the_old_checkpoint)
{
  scene s = create_scene();
  const char *file = path_in_folder("checkpoint"); /* few other paths are asked for below */
  struct rlimit unlimited, limited;
  write_bytes(file, s.past.at, s.past.count);
  ck_assert_int_eq(getrlimit(RLIMIT_FSIZE, &unlimited), 0);
  limited = unlimited;
  ck_assert(signal(SIGXFSZ, SIG_IGN) != SIG_ERR);
  for (rlim_t room = 0; room < s.past.count; room += 40) {
    limited.rlim_cur = room;
    ck_assert_int_eq(setrlimit(RLIMIT_FSIZE, &limited), 0);
    const dvi_status status = dvi_integrator_save(s.integrator, file);
    ck_assert_int_eq(setrlimit(RLIMIT_FSIZE, &unlimited), 0);
    ck_assert_int_eq(status, DVI_IO_ERROR);
    check_words("File too large");
    ck_assert_int_eq(count_files_in_folder(), 1); /* and no half of the new one */
    const bytes old = read_bytes(file);
    ck_assert_uint_eq(old.count, s.past.count);
    ck_assert_mem_eq(old.at, s.past.at, old.count);
    free(old.at);
  }
  ck_assert_int_eq(dvi_integrator_save(s.integrator, file), DVI_OK);
  clear_scene(&s);
}
END_TEST

SUITE(checkpoint_places)
{
  tcase_set_timeout(tests, 120); /* every file is flushed to the disk, which may be busy */
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_test(tests, a_place_that_cannot_be_written_is_reported);
  tcase_add_test(tests, a_link_is_followed_and_stays);
  tcase_add_test(tests, a_pipe_is_no_place_for_a_checkpoint);
  tcase_add_test(tests, neither_neighbours_nor_the_file_s_rights_change);
  tcase_add_test(tests, a_full_disk_leaves_the_old_checkpoint);
}
