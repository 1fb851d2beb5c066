/* A scene as a C file: its functions by emit.h, callbacks of the batch shape or of the one-point shape around them, and the terms that they belong to. */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "scene/callbacks.h"
#include "scene/emit.h"

/* A callback: its arguments, and what of them the function reads and writes. `asks` is 'v', 'g' or 's': the value, the gradient or second derivatives. */
typedef struct callback {
  const char *name, *arguments, *count, *x, *result;
  char asks;
  unsigned mask;
} callback;

#define BATCH "int count, const double *t, const double *q"
#define POINT "double t, const double *q"
#define BLOCK(b) (1U << (b))
#define SECOND (BLOCK(DVI__PAIR_QQ) | BLOCK(DVI__PAIR_QV) | BLOCK(DVI__PAIR_VV))

static const callback potential_callbacks[] = {
    {"value_batch", BATCH ", double *V", "count", "t, q, NULL, NULL", "[0] = V", 'v', 0},
    {"gradient_batch", BATCH ", double *V_q", "count", "t, q, NULL, NULL", "[1] = V_q", 'g', BLOCK(DVI__COORDINATES)},
    {"hessian_batch", BATCH ", double *V_qq", "count", "t, q, NULL, NULL", "[0] = V_qq", 's', BLOCK(DVI__PAIR_QQ)},
    {"rate_batch", BATCH ", double *V_t", "count", "t, q, NULL, NULL", "[0] = V_t", 'g', BLOCK(DVI__TIME)},
};

static const callback lagrangian_callbacks[] = {
    {"value_batch", BATCH ", const double *v, double *L", "count", "t, q, v, NULL", "[0] = L", 'v', 0},
    {"gradient_batch", BATCH ", const double *v, double *L_q, double *L_v", "count", "t, q, v, NULL", "[1] = L_q, [2] = L_v", 'g',
     BLOCK(DVI__COORDINATES) | BLOCK(DVI__VELOCITIES)},
    {"hessian_batch", BATCH ", const double *v, double *L_qq, double *L_qv, double *L_vv", "count", "t, q, v, NULL",
     "[0] = L_qq, [1] = L_qv, [2] = L_vv", 's', SECOND},
    {"rate_batch", BATCH ", const double *v, double *L_t", "count", "t, q, v, NULL", "[0] = L_t", 'g', BLOCK(DVI__TIME)},
};

static const callback form_callbacks[] = {
    {"value", "const double *q, double *alpha", "1", "NULL, q, NULL, dvi_zeros", "[3] = alpha", 'g', BLOCK(DVI__MULTIPLIERS)},
    {"gradient", "const double *q, double *alpha_q", "1", "NULL, q, NULL, dvi_zeros", "[3] = alpha_q", 's', BLOCK(DVI__PAIR_QW)},
    {"hessian", "const double *q, const double *w, double *alpha_w_qq", "1", "NULL, q, NULL, w", "[0] = alpha_w_qq", 's',
     BLOCK(DVI__PAIR_QQ)},
};

static const callback generator_callback = {"generator", "const double *q, double *xi", "1", "NULL, q, NULL, dvi_zeros", "[3] = xi",
                                            'g',         BLOCK(DVI__MULTIPLIERS)};
static const callback invariant_callback = {"value", POINT ", const double *p, double *I", "1", "&t, q, p, NULL", "[0] = I", 'v',
                                            0};

/* ---- callbacks ---- */

/* The function of a term under a name, and the callback that calls it. */
static dvi_status emit_callback(dvi__emitter *out, const dvi__term *term, const char *name, const callback *c)
{
  char function[64];
  (void)snprintf(function, sizeof function, "%s_%s_of", name, c->name);
  const dvi_status status = c->asks == 'v'   ? dvi__emit_value(out, term->function, function)
                            : c->asks == 'g' ? dvi__emit_gradient(out, term->function, c->mask, function)
                                             : dvi__emit_second(out, term->function, c->mask, function);
  if (status != DVI_OK) return status;
  dvi__emit(out, "\nstatic int %s_%s(%s, void *user)\n{\n", name, c->name, c->arguments);
  dvi__emit(out, "  const double *const x[%d] = {%s};\n  double *const result[%d] = {%s};\n", (int)DVI__BLOCKS, c->x,
            (int)DVI__PAIRS, c->result);
  dvi__emit(out, "  (void)user;\n  %s(%s, x, result);\n  return 0;\n}\n\n", function, c->count);
  return DVI_OK;
}

/* All callbacks of a term but its rate, which only systems with time have: that is the last one of four. */
static dvi_status emit_callbacks(dvi__emitter *out, const dvi_scene *scene, const dvi__term *term, const char *name, int count,
                                 const callback *c)
{
  dvi_status status = DVI_OK;
  for (int k = 0; k < count && status == DVI_OK; k++)
    if (k < 3 || !scene->terms.autonomous) status = emit_callback(out, term, name, &c[k]);
  return status;
}

static dvi_status emit_all_callbacks(dvi__emitter *out, const dvi_scene *scene)
{
  const dvi_system_terms *terms = &scene->terms;
  char name[32];
  dvi_status status = DVI_OK;
  if (terms->lagrangian != NULL)
    status = emit_callbacks(out, scene, terms->lagrangian->user, "lagrangian", 4, lagrangian_callbacks);
  if (terms->one_form != NULL) status = emit_callbacks(out, scene, terms->one_form->user, "one_form", 3, form_callbacks);
  for (int k = 0; k < terms->potential_count && status == DVI_OK; k++) {
    (void)snprintf(name, sizeof name, "potential_%d", k);
    status = emit_callbacks(out, scene, terms->potentials[k].user, name, 4, potential_callbacks);
  }
  for (int k = 0; k < terms->symmetry_count && status == DVI_OK; k++) {
    (void)snprintf(name, sizeof name, "symmetry_%d", k);
    status = emit_callback(out, terms->symmetries[k].user, name, &generator_callback);
  }
  for (int k = 0; k < terms->invariant_count && status == DVI_OK; k++) {
    (void)snprintf(name, sizeof name, "invariant_%d", k);
    status = emit_callback(out, terms->invariants[k].user, name, &invariant_callback);
  }
  return status;
}

/* ---- terms ---- */

/* The arrays of a pattern; -1 in both: a full one. */
static void emit_pattern_arrays(dvi__emitter *out, int columns, const dvi_pattern *pattern, int number[2])
{
  number[0] = number[1] = -1;
  if (pattern->start == NULL) return;
  number[0] = dvi__emit_ints(out, columns + 1, pattern->start);
  if (pattern->start[columns] > 0) number[1] = dvi__emit_ints(out, pattern->start[columns], pattern->row);
}

static void emit_pattern(dvi__emitter *out, const char *field, const int number[2])
{
  if (number[0] < 0) return;
  dvi__emit(out, "    .%s = {dvi_list_%d, ", field, number[0]);
  if (number[1] < 0)
    dvi__emit(out, "NULL},\n");
  else
    dvi__emit(out, "dvi_list_%d},\n", number[1]);
}

static void emit_fields(dvi__emitter *out, const dvi_scene *scene, const char *name, int count, const callback *c)
{
  for (int k = 0; k < count; k++)
    if (k < 3 || !scene->terms.autonomous) dvi__emit(out, "    .%s = %s_%s,\n", c[k].name, name, c[k].name);
}

static void emit_text(dvi__emitter *out, const char *text)
{
  dvi__emit(out, "\"");
  for (; *text != '\0'; text++) dvi__emit(out, *text == '"' || *text == '\\' ? "\\%c" : "%c", *text);
  dvi__emit(out, "\"");
}

static void emit_lagrangian(dvi__emitter *out, const dvi_scene *scene)
{
  const dvi_lagrangian *L = &scene->lagrangian;
  int qq[2], qv[2], vv[2];
  emit_pattern_arrays(out, scene->n, &L->qq, qq);
  emit_pattern_arrays(out, scene->n, &L->qv, qv);
  emit_pattern_arrays(out, scene->n, &L->vv, vv);
  dvi__emit(out, "static const dvi_lagrangian lagrangian = {\n");
  emit_fields(out, scene, "lagrangian", 4, lagrangian_callbacks);
  emit_pattern(out, "qq", qq);
  emit_pattern(out, "qv", qv);
  emit_pattern(out, "vv", vv);
  dvi__emit(out, "};\n\n");
}

static void emit_one_form(dvi__emitter *out, const dvi_scene *scene)
{
  int gradients[2], qq[2];
  emit_pattern_arrays(out, scene->n, &scene->one_form.gradients, gradients);
  emit_pattern_arrays(out, scene->n, &scene->one_form.qq, qq);
  dvi__emit(out, "static const dvi_one_form one_form = {\n");
  emit_fields(out, scene, "one_form", 3, form_callbacks);
  emit_pattern(out, "gradients", gradients);
  emit_pattern(out, "qq", qq);
  dvi__emit(out, "};\n\n");
}

static void emit_potential(dvi__emitter *out, const dvi_scene *scene, int k)
{
  const dvi_potential *V = &scene->terms.potentials[k];
  char name[32];
  int qq[2];
  (void)snprintf(name, sizeof name, "potential_%d", k);
  emit_pattern_arrays(out, scene->n, &V->qq, qq);
  dvi__emit(out, "static const dvi_potential %s = {\n    .name = ", name);
  emit_text(out, V->name);
  dvi__emit(out, ",\n");
  emit_fields(out, scene, name, 4, potential_callbacks);
  if (V->fast) dvi__emit(out, "    .fast = 1,\n");
  if (V->quadratic) dvi__emit(out, "    .quadratic = 1,\n");
  emit_pattern(out, "qq", qq);
  dvi__emit(out, "};\n\n");
}

/* The constant mass as statements. */
static void emit_mass(dvi__emitter *out, const dvi_mass *mass, const int pattern[2], int row)
{
  if (mass->diagonal != NULL) {
    dvi__emit(out, "  terms.mass.diagonal = dvi_row_%d;\n", row);
  } else if (mass->values != NULL) {
    dvi__emit(out, "  terms.mass.values = dvi_row_%d;\n", row);
    if (pattern[0] >= 0)
      dvi__emit(out, "  terms.mass.pattern = (dvi_pattern){dvi_list_%d, dvi_list_%d};\n", pattern[0], pattern[1]);
  } else if (mass->scalar < 0 || mass->scalar > 0) {
    dvi__emit(out, "  terms.mass.scalar = ");
    dvi__emit_number(out, mass->scalar);
    dvi__emit(out, ";\n");
  }
}

/* Statements that put terms, one after the other, in a list of the function. */
static void emit_watched(dvi__emitter *out, const dvi_system_terms *terms)
{
  for (int k = 0; k < terms->symmetry_count; k++) {
    dvi__emit(out, "  symmetries[%d] = (dvi_symmetry){.name = ", k);
    emit_text(out, terms->symmetries[k].name);
    dvi__emit(out, ", .generator = symmetry_%d_generator};\n", k);
  }
  for (int k = 0; k < terms->invariant_count; k++) {
    dvi__emit(out, "  invariants[%d] = (dvi_invariant){.name = ", k);
    emit_text(out, terms->invariants[k].name);
    dvi__emit(out, ", .value = invariant_%d_value};\n", k);
  }
}

/* A local list of a kind of terms, if there are any. */
static void emit_list(dvi__emitter *out, const char *type, const char *list, const char *count, int length)
{
  if (length > 0)
    dvi__emit(out, "  %s %s[%d];\n  terms.%s = %s;\n  terms.%s = %d;\n", type, list, length, list, list, count, length);
}

static void emit_create(dvi__emitter *out, const dvi_scene *scene, const char *name)
{
  const dvi_system_terms *terms = &scene->terms;
  const dvi_mass *mass = &terms->mass;
  int pattern[2] = {-1, -1}, row = -1;
  if (mass->diagonal != NULL) row = dvi__emit_doubles(out, scene->n, mass->diagonal);
  if (mass->values != NULL) {
    emit_pattern_arrays(out, scene->n, &mass->pattern, pattern);
    row = dvi__emit_doubles(out, mass->pattern.start == NULL ? scene->n * scene->n : mass->pattern.start[scene->n], mass->values);
  }
  dvi__emit(out, "dvi_status %s_create(dvi_system **system)\n{\n  dvi_system_terms terms = {.dimension = %d, .autonomous = %d};\n",
            name, scene->n, terms->autonomous);
  emit_list(out, "dvi_potential", "potentials", "potential_count", terms->potential_count);
  emit_list(out, "dvi_symmetry", "symmetries", "symmetry_count", terms->symmetry_count);
  emit_list(out, "dvi_invariant", "invariants", "invariant_count", terms->invariant_count);
  for (int k = 0; k < terms->potential_count; k++) dvi__emit(out, "  potentials[%d] = potential_%d;\n", k, k);
  emit_watched(out, terms);
  if (terms->lagrangian != NULL) dvi__emit(out, "  terms.lagrangian = &lagrangian;\n");
  if (terms->one_form != NULL) dvi__emit(out, "  terms.one_form = &one_form;\n");
  emit_mass(out, mass, pattern, row);
  dvi__emit(out, "  return dvi_system_create(&terms, system);\n}\n");
}

static void emit_start(dvi__emitter *out, const char *name, const char *letter, int n, const double *x)
{
  dvi__emit(out, "\nconst double %s_%s[%d] = {\n", name, letter, n);
  for (int i = 0; i < n; i++) {
    dvi__emit(out, "    ");
    dvi__emit_number(out, x[i]);
    dvi__emit(out, ",\n");
  }
  dvi__emit(out, "};\n");
}

/* What a caller declares, and the zeros at which functions that are linear in w are asked. */
static void emit_head(dvi__emitter *out, const dvi_scene *scene, const char *name)
{
  dvi__emit_begin(out);
  dvi__emit(out, "#include <dvi/dvi.h>\n\n/* The system, and its start. */\ndvi_status %s_create(dvi_system **system);\n", name);
  dvi__emit(out, "extern const double %s_q[%d], %s_v[%d], %s_p[%d];\n\n", name, scene->n, name, scene->n, name, scene->n);
  if (scene->terms.one_form != NULL || scene->terms.symmetry_count > 0)
    dvi__emit(out, "static const double dvi_zeros[%d] = {0};\n\n", scene->n);
}

static int is_identifier(const char *name)
{
  int length = 0;
  if (!isalpha((unsigned char)*name) && *name != '_') return 0;
  for (; name[length] != '\0'; length++)
    if (!isalnum((unsigned char)name[length]) && name[length] != '_') return 0;
  return length <= 63;
}

dvi_status dvi_scene_emit_c(const dvi_scene *scene, const char *name, int (*write)(const char *text, size_t size, void *user),
                            void *user)
{
  if (scene == NULL || name == NULL || write == NULL || !is_identifier(name)) return DVI_BAD_ARGUMENT;
  if (scene->terms.hamiltonian != NULL || scene->terms.factors != NULL) return DVI_UNSUPPORTED;
  dvi__emitter out = {.write = write, .user = user};
  emit_head(&out, scene, name);
  const dvi_status status = emit_all_callbacks(&out, scene);
  if (status == DVI_OK) {
    if (scene->terms.lagrangian != NULL) emit_lagrangian(&out, scene);
    if (scene->terms.one_form != NULL) emit_one_form(&out, scene);
    for (int k = 0; k < scene->terms.potential_count; k++) emit_potential(&out, scene, k);
    emit_create(&out, scene, name);
    emit_start(&out, name, "q", scene->n, scene->q);
    emit_start(&out, name, "v", scene->n, scene->v);
    emit_start(&out, name, "p", scene->n, scene->p);
  }
  const dvi_status ended = dvi__emit_end(&out);
  return status != DVI_OK ? status : ended;
}
