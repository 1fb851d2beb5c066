#define _POSIX_C_SOURCE 200809L /* clock_gettime, pwrite */
#include "support/scene/fuzz.h"

#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define WATCHED 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#define WATCHED 1
#endif

enum { TEXT_MAX = 1 << 13, POOL_MAX = 4096, OUTCOMES = 1 << 16, ROUNDS = 64 };

typedef struct text {
  size_t size;
  char at[TEXT_MAX];
} text;

typedef struct pool {
  size_t count;
  char *at[POOL_MAX];
  size_t size[POOL_MAX];
} pool;

static pool corpus;
static uint64_t state;

/* Draws a number from 0 to bound - 1, by splitmix64. */
static size_t random_below(size_t bound)
{
  state += 0x9E3779B97F4A7C15U;
  uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return (size_t)((z ^ (z >> 31)) % bound);
}

/* Adds a text to the corpus, in place of any other text if the corpus is full. */
static void add_to_corpus(const char *at, size_t size)
{
  const size_t place = corpus.count < POOL_MAX ? corpus.count++ : random_below(POOL_MAX);
  char *copy = malloc(size + 1);
  fuzz_requires(copy != NULL);
  memcpy(copy, at, size);
  free(corpus.at[place]);
  corpus.at[place] = copy;
  corpus.size[place] = size;
}

static void clear_corpus(void)
{
  for (size_t k = 0; k < corpus.count; k++) free(corpus.at[k]);
  corpus = (pool){0};
}

/* Puts `size` bytes in the place of `gone` others, if there is room. */
static void replace(text *t, size_t place, size_t gone, const char *by, size_t size)
{
  if (t->size - gone + size > TEXT_MAX) return;
  memmove(t->at + place + size, t->at + place + gone, t->size - place - gone);
  memcpy(t->at + place, by, size);
  t->size = t->size - gone + size;
}

/* Draws a length up to `bound`, more often a short one. */
static size_t random_part(size_t bound)
{
  return bound == 0 ? 0 : random_below(random_below(bound) + 1);
}

static void put_token(text *t, const char *const *tokens)
{
  size_t count = 0;
  while (tokens[count] != NULL) count++;
  const char *token = tokens[random_below(count)];
  const size_t place = random_below(t->size + 1);
  replace(t, place, random_below(2) == 0 ? 0 : random_part(t->size - place + 1), token,
          strlen(token));
}

/* Puts in a part of another text. */
static void splice(text *t)
{
  const size_t other = random_below(corpus.count);
  const size_t first = random_below(corpus.size[other] + 1);
  const size_t place = random_below(t->size + 1);
  replace(t, place, random_part(t->size - place + 1), corpus.at[other] + first,
          random_part(corpus.size[other] - first + 1));
}

/* Repeats a part of the text some times. */
static void repeat(text *t)
{
  static char copy[TEXT_MAX];
  const size_t first = random_below(t->size + 1);
  const size_t size = random_part(t->size - first + 1);
  memcpy(copy, t->at + first, size);
  for (size_t k = random_below(random_below(8) == 0 ? 200 : 4) + 1; k > 0; k--)
    replace(t, first, 0, copy, size);
}

static void mutate(text *t, const char *const *tokens)
{
  const size_t place = random_below(t->size + 1);
  const char byte = (char)random_below(256);
  switch (random_below(8)) {
  case 0: replace(t, place, random_part(t->size - place + 1), "", 0); break;
  case 1: replace(t, place, 0, &byte, 1); break;
  case 2:
    if (place < t->size) t->at[place] = (char)(t->at[place] ^ (1 << random_below(8)));
    break;
  case 3: splice(t); break;
  case 4: repeat(t); break;
  default: put_token(t, tokens); break;
  }
}

/* Draws a text. Texts grow by mutation, and short ones take less time. */
static size_t shorter_of_two(void)
{
  const size_t a = random_below(corpus.count);
  const size_t b = random_below(corpus.count);
  return corpus.size[a] < corpus.size[b] ? a : b;
}

/* Tries a copy of the text whose memory ends with it, so that the sanitizer sees a byte read
 * beyond. */
static unsigned try_text(const fuzz_target *target, const char *at, size_t size)
{
  char *exact = malloc(size > 0 ? size : 1);
  fuzz_requires(exact != NULL);
  memcpy(exact, at, size);
  const unsigned outcome = target->try_text(exact, size);
  free(exact);
  return outcome % OUTCOMES;
}

static double seconds_now(void)
{
  struct timespec time;
  (void)clock_gettime(CLOCK_MONOTONIC, &time);
  return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static int seconds_asked(void)
{
  const char *asked = getenv("DVI_FUZZ_SECONDS");
  if (asked != NULL) return (int)strtol(asked, NULL, 10);
#ifdef WATCHED
  return 30;
#else
  return 2;
#endif
}

int fuzz_timeout(void)
{
  return 60 + seconds_asked();
}

static long try_file(const fuzz_target *target, const char *path)
{
  static char at[TEXT_MAX];
  FILE *file = fopen(path, "rb");
  ck_assert_msg(file != NULL, "%s cannot be read", path);
  const size_t size = fread(at, 1, sizeof at, file);
  fclose(file);
  (void)try_text(target, at, size);
  return 1;
}

static long try_for(const fuzz_target *target, int seconds, int file)
{
  static text t;
  static char seen[OUTCOMES];
  long tried = 0;
  for (const double end = seconds_now() + seconds; seconds_now() < end;)
    for (int round = 0; round < ROUNDS; round++, tried++) {
      const size_t from = shorter_of_two();
      t.size = corpus.size[from];
      memcpy(t.at, corpus.at[from], t.size);
      for (size_t k = random_below(6) + 1; k > 0; k--) mutate(&t, target->tokens);
      fuzz_requires(pwrite(file, t.at, t.size, 0) == (ssize_t)t.size &&
                    ftruncate(file, (off_t)t.size) == 0);
      const unsigned outcome = try_text(target, t.at, t.size);
      if (!seen[outcome]) add_to_corpus(t.at, t.size);
      seen[outcome] = 1;
    }
  return tried;
}

long fuzz(const fuzz_target *target)
{
  if (getenv("DVI_FUZZ_TEXT") != NULL) return try_file(target, getenv("DVI_FUZZ_TEXT"));
  char path[80];
  (void)snprintf(path, sizeof path, "fuzz-%s.txt", target->name);
  const int file = open(path, O_RDWR | O_CREAT | O_TRUNC, 0600);
  ck_assert_int_ge(file, 0);
  state = 0;
  for (int k = 0; target->corpus[k] != NULL; k++) {
    const size_t size = target->size != NULL ? target->size[k] : strlen(target->corpus[k]);
    (void)try_text(target, target->corpus[k], size);
    add_to_corpus(target->corpus[k], size);
  }
  const long tried = try_for(target, seconds_asked(), file);
  printf("%s: %ld texts tried, %zu kept\n", target->name, tried, corpus.count);
  clear_corpus();
  (void)close(file);
  (void)unlink(path);
  return tried;
}

unsigned fuzz_hash(const char *message)
{
  unsigned hash = 2166136261U; /* FNV-1a */
  int quoted = 0;
  for (; *message != '\0' && *message != '\n'; message++) {
    if (*message == '\'') quoted = !quoted;
    if (quoted || (*message >= '0' && *message <= '9')) continue;
    hash = (hash ^ (unsigned char)*message) * 16777619U;
  }
  return hash ^ hash >> 16;
}
