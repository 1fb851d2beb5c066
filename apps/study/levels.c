#include "study/levels.h"

#include <float.h>
#include <math.h>

enum { SEARCH_TRIES = 40, ROOM_LEVELS = 6 };

/* Largest number of parts of a first level that is searched, so that the search ends within
 * seconds, and of the last level after it. */
static const long search_max = 1L << 17, finest_max = 1L << 22;

/* Least ratio of the first error to the floor. It leaves five decades for the levels. */
static const double level_room = 1e5;

/* an error of 1 % of the solution's size is no longer asymptotic */
static const double ceiling_digits = 1e-2;

/* The state of a search. */
typedef struct search {
  const study_subject *subject;
  const levels_request *request;
  levels_choice *choice;
  study_level first; /* level that was tried last */
} search;

static double clamp(double x, double low, double high)
{
  return fmin(fmax(x, low), high);
}

/* Choose a target for the first level's error. A high order shows late, when the terms beyond the
 * leading one have died out, but passes its few levels in many digits. A low order needs too many
 * parts to come near the floor. */
static double first_target(const search *s)
{
  const double size = s->subject->size, order = s->subject->order;
  if (s->request->first_error > 0.0) return s->request->first_error * size;
  const double digits = fmax(3.0 + 0.5 * order, fmin(1.0 + order, 15.0));
  return clamp(level_room * s->choice->floor, pow(10.0, -digits) * size, 0.1 * s->choice->ceiling);
}

/* Predict the number of parts from one error by the order. The number lies strictly between too_few
 * and enough, which is 0 if unknown. */
static long next_guess(const search *s, long parts, double error, double target, long too_few,
                       long enough)
{
  const double factor = isfinite(error)
                            ? clamp(pow(error / target, 1.0 / s->subject->order), 0.25, 4.0)
                            : 2.0;
  const double high = enough > 0 ? (double)enough - 1.0 : (double)search_max;
  return lround(clamp(ceil((double)parts * factor), (double)too_few + 1.0, high));
}

static dvi_status try_level(search *s, long parts)
{
  return study_run(s->subject, (double)parts, &s->first);
}

/* Search for the first level, of more parts than too_few, whose error is the nearest below three
 * times the target. A level without a result is too rough. */
static dvi_status find_first(search *s, long too_few, long *first)
{
  const double target = first_target(s);
  long fine = 0; /* last level below the target, 0 if there is none yet */
  study_level of_fine = {0};
  *first = lround(clamp(ceil(s->subject->first_parts), (double)too_few + 1.0, (double)search_max));
  for (int i = 0; i < SEARCH_TRIES; i++) {
    const dvi_status status = try_level(s, *first);
    if (status < 0) return status;
    const double error = status == DVI_OK ? s->first.error : (double)NAN;
    if (error <= 3.0 * target && error >= 0.1 * target) return DVI_OK;
    if (error <= 3.0 * target) {
      fine = *first;
      of_fine = s->first;
    } else {
      too_few = *first;
    }
    if (too_few + 1 == fine || too_few >= search_max) break;
    *first = next_guess(s, *first, error, target, too_few, fine);
  }
  *first = fine > 0 ? fine : too_few;
  if (fine == 0) return try_level(s, too_few);
  s->first = of_fine;
  return DVI_OK;
}

static dvi_status find_floor(search *s, long parts)
{
  const study_subject *subject = s->subject;
  double moved = 0.0;
  const dvi_status status = subject->roundoff != NULL
                                ? subject->roundoff(subject->user, (double)parts, &moved)
                                : DVI_OK;
  moved = fmax(DBL_EPSILON * subject->size, status == DVI_OK ? moved : 0.0);
  s->choice->floor = STUDY_FLOOR_MARGIN * fmax(subject->judge_error, moved);
  return status;
}

/* Find the first level, and the floor there. A level without a result at the floor depends on
 * roundoff and is too rough, too. */
static dvi_status find_first_and_floor(search *s, long *first)
{
  long too_few = 0;
  dvi_status status = find_first(s, too_few, first);
  while (status == DVI_OK && (status = find_floor(s, *first)) > 0 && *first < search_max) {
    too_few = *first;
    status = find_first(s, too_few, first);
  }
  /* Repeat the search, now that the floor is known. */
  return status == DVI_OK ? find_first(s, too_few, first) : status;
}

/* Choose the ratio that leads from the first error to a little above the floor, if possible with at
 * most so many parts. */
static double choose_ratio(const search *s, long first, double finest)
{
  const int levels = s->request->count;
  const double span = s->first.error / (3.0 * s->choice->floor);
  const double ratio = span > 1.0 && levels > 1
                           ? pow(span, 1.0 / (s->subject->order * (levels - 1.0)))
                           : 1.0;
  const double most = levels > 1 ? pow(finest / (double)first, 1.0 / (levels - 1.0)) : 2.0;
  return clamp(ratio, 1.05, clamp(most, 1.05, 2.0));
}

/* Return whether so many levels, each with one part more than the one before, stay above the
 * floor. */
static bool levels_have_room(const search *s, long first, int levels)
{
  const double finest = (double)(first + levels - 1);
  return s->first.error * pow((double)first / finest, s->subject->order) > s->choice->floor;
}

/* Return whether even many parts fail, or end far from the solution. Finer levels would cost much
 * and tell nothing. */
static bool is_lost(const search *s, dvi_status status)
{
  static const double far = 10.0; /* multiple of the largest error that tells an order */
  return s->subject->may_miss &&
         (status > 0 || (status == DVI_OK && !(s->first.error <= far * s->choice->ceiling)));
}

static void set_parts(const search *s, long first, double ratio)
{
  long *parts = s->choice->parts;
  parts[0] = first;
  for (int k = 1; k < s->request->count; k++) {
    parts[k] = lround((double)first * pow(ratio, k));
    if (parts[k] <= parts[k - 1]) parts[k] = parts[k - 1] + 1;
  }
}

dvi_status levels_choose(const study_subject *subject, const levels_request *request,
                         levels_choice *choice)
{
  search s = {.subject = subject, .request = request, .choice = choice};
  const bool given = request->length > 0.0;
  long first = 0;
  dvi_status status;
  *choice = (levels_choice){.ceiling = ceiling_digits * subject->size,
                            .floor = STUDY_FLOOR_MARGIN * subject->judge_error};
  if (given) {
    first = lround(clamp(fabs(subject->span) / request->length, 1.0, (double)FIRST_PARTS_MAX));
    status = try_level(&s, first);
    if (status == DVI_OK) status = find_floor(&s, first);
  } else {
    status = find_first_and_floor(&s, &first);
    if (is_lost(&s, status)) return DVI_OK;
  }
  if (status != DVI_OK) return status;
  choice->room = levels_have_room(&s, first,
                                  request->count < ROOM_LEVELS ? request->count : ROOM_LEVELS);
  const double finest = given ? HUGE_VAL : (double)finest_max;
  set_parts(&s, first, request->ratio > 0.0 ? request->ratio : choose_ratio(&s, first, finest));
  return DVI_OK;
}
