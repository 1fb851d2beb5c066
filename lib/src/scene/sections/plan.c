/* The sections title, method, step and until, the plan of the scene's run. */
#include "scene/elaborate/words.h"
#include "scene/sections/sections.h"

bool dvi__read_title(dvi_scene *scene, const dvi__tree *section)
{
  scene->plan.title = section->text;
  return dvi__want_text(scene, section, "title");
}

bool dvi__read_method(dvi_scene *scene, const dvi__tree *section)
{
  scene->plan.method = section->text;
  return dvi__want_text(scene, section, "method") &&
         dvi__scene_place_file(scene, section->span, &scene->plan.method);
}

static bool plan_number(dvi_scene *scene, const dvi__tree *section, const char *name,
                        double *number)
{
  if (!dvi__tree_number(scene, section, name, number)) return false;
  return *number > 0 || dvi__scene_refuse(scene, section->span, "%s must be positive, and is %.17g",
                                          name, *number);
}

static bool refuse_step(dvi_scene *scene, const dvi__tree *section)
{
  static const char is[] = "a step is a number, or '{fraction: 0.5}' of the largest stable one";
  return section->kind == DVI__SCALAR
             ? dvi__scene_refuse(scene, section->span, "'%s' is no parameter; %s", section->text,
                                 is)
             : dvi__scene_refuse(scene, section->span, "%s", is);
}

/* Tell if a text is a name that means nothing. */
static bool is_unknown_name(const dvi_scene *scene, const char *text)
{
  return dvi__is_identifier(text) && !dvi__is_word(text) &&
         dvi__names_find(&scene->names, text) == NULL;
}

/* Read a step of a field as a fraction of the largest stable one. */
static bool read_fraction(dvi_scene *scene, const dvi__tree *section)
{
  static const char *const known[] = {"fraction"};
  if (!dvi__want_keys(scene, section, "a step", 1, known)) return false;
  if (section->count != 1) return refuse_step(scene, section);
  if (!plan_number(scene, section->child[0], "fraction", &scene->plan.fraction)) return false;
  return scene->plan.fraction < 1 ||
         dvi__scene_refuse(scene, section->span,
                           "a fraction of the largest stable step is below "
                           "1, and is %.17g",
                           scene->plan.fraction);
}

bool dvi__read_step(dvi_scene *scene, const dvi__tree *section)
{
  if (dvi__is_of_field(scene)) {
    if (section->kind == DVI__MAPPING) return read_fraction(scene, section);
    if (section->kind == DVI__SEQUENCE || is_unknown_name(scene, section->text))
      return refuse_step(scene, section);
  }
  return plan_number(scene, section, "step", &scene->plan.h);
}

/* Read the end of a run. With more steps than a double can count the time would stand still. */
bool dvi__read_until(dvi_scene *scene, const dvi__tree *section)
{
  static const double steps_max = 9007199254740992.0; /* 2^53 */
  if (!plan_number(scene, section, "until", &scene->plan.t_end)) return false;
  const double steps = scene->plan.h > 0 ? scene->plan.t_end / scene->plan.h : 0;
  return steps <= steps_max ||
         dvi__complain(scene->complaint, DVI_BAD_SIZE, dvi__tree_find(scene->tree, "step")->span,
                       "a run of %.3g steps; at most %.16g (2^53) are possible", steps, steps_max);
}
