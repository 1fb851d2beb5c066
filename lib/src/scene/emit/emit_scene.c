/* A scene as a C file. The file has declarations for programs, the terms, a function that makes the
 * system, its start and its plan, and a program that runs it. */
#include <dvi/integrator.h>
#include <string.h>

#include "scene/emit/emit_scene.h"
#include "text/heap.h"
#include "scene/elaborate/names.h"

enum { IDENTIFIER_MAX = 63 }; /* letters of a name that surely count in C */

/* ---- terms ---- */

/* Count the constraints that are functions of the scene, which those of joints are not. */
static int holonomic_functions(const dvi_scene *scene)
{
  return scene->terms.holonomic_count - (scene->joint_count > 0);
}

static dvi_status emit_motion(dvi__emitter *out, const dvi_scene *scene)
{
  const dvi_system_terms *terms = &scene->terms;
  dvi__emitted_term term;
  dvi_status status = DVI_OK;
  if (terms->lagrangian != NULL)
    term = dvi__lagrangian_term(scene), status = dvi__emit_term(out, &term);
  if (terms->one_form != NULL && status == DVI_OK)
    term = dvi__one_form_term(scene), status = dvi__emit_term(out, &term);
  if (terms->vector_potential != NULL && status == DVI_OK)
    term = dvi__vector_term_of(scene), status = dvi__emit_term(out, &term);
  if (terms->hamiltonian != NULL && status == DVI_OK)
    term = dvi__hamiltonian_term(scene), status = dvi__emit_term(out, &term);
  if (terms->constraint != NULL && status == DVI_OK)
    term = dvi__constraint_term(scene), status = dvi__emit_term(out, &term);
  for (int k = 0; k < terms->potential_count && status == DVI_OK; k++)
    term = dvi__potential_term(scene, k), status = dvi__emit_term(out, &term);
  for (int k = 0; k < scene->noise.function_count && status == DVI_OK; k++)
    term = dvi__noise_function_term(scene, k), status = dvi__emit_term(out, &term);
  for (int k = 0; k < terms->force_count && status == DVI_OK; k++)
    term = dvi__force_term_of(scene, k), status = dvi__emit_term(out, &term);
  for (int k = 0; k < holonomic_functions(scene) && status == DVI_OK; k++)
    term = dvi__holonomic_term_of(scene, k), status = dvi__emit_term(out, &term);
  for (int k = 0; k < terms->nonholonomic_count && status == DVI_OK; k++)
    term = dvi__nonholonomic_term_of(scene, k), status = dvi__emit_term(out, &term);
  return status;
}

static dvi_status emit_watched(dvi__emitter *out, const dvi_scene *scene)
{
  dvi__emitted_term term;
  dvi_status status = DVI_OK;
  for (int k = 0; k < scene->terms.symmetry_count && status == DVI_OK; k++)
    term = dvi__symmetry_term(scene, k), status = dvi__emit_term(out, &term);
  for (int k = 0; k < scene->terms.invariant_count && status == DVI_OK; k++)
    term = dvi__invariant_term(scene, k), status = dvi__emit_term(out, &term);
  for (int k = 0; k < scene->event_count && status == DVI_OK; k++)
    term = dvi__event_term(scene, k), status = dvi__emit_callbacks(out, &term);
  return status;
}

/* ---- the system ---- */

/* Write the constant mass as statements. */
static void emit_mass(dvi__emitter *out, const dvi_mass *mass, const int pattern[2], int row)
{
  if (mass->diagonal != NULL) {
    dvi__emit(out, "  terms.mass.diagonal = dvi_row_%d;\n", row);
  } else if (mass->values != NULL) {
    dvi__emit(out, "  terms.mass.values = dvi_row_%d;\n", row);
    if (pattern[0] >= 0)
      dvi__emit(out, "  terms.mass.pattern = (dvi_pattern){dvi_list_%d, dvi_list_%d};\n",
                pattern[0], pattern[1]);
  } else if (mass->scalar < 0 || mass->scalar > 0) {
    dvi__emit(out, "  terms.mass.scalar = ");
    dvi__emit_number(out, mass->scalar);
    dvi__emit(out, ";\n");
  }
}

/* Write the list of a kind of terms, if there are any. */
static void emit_term_list(dvi__emitter *out, const char *type, const char *term, const char *list,
                           int length)
{
  if (length == 0) return;
  dvi__emit(out, "  const %s %s[] = {", type, list);
  for (int k = 0; k < length; k++) dvi__emit(out, "%s%s_%d", k == 0 ? "" : ", ", term, k);
  dvi__emit(out, "};\n  terms.%s = %s;\n  terms.%s_count = %d;\n", list, list, term, length);
}

/* Write the arrays of factors, before the function. */
static void emit_inertias(dvi__emitter *out, const dvi_system_terms *terms)
{
  for (int k = 0; k < terms->factor_count; k++) {
    if (terms->factors[k].inertia != NULL)
      (void)dvi__emit_doubles(out, 9, terms->factors[k].inertia);
    if (terms->factors[k].centre != NULL) (void)dvi__emit_doubles(out, 3, terms->factors[k].centre);
  }
}

static void emit_factor(dvi__emitter *out, const dvi_factor *factor)
{
  dvi__emit(out, "      {.kind = %s, .size = %d, .mass = ", dvi__factor_kind_name(factor->kind),
            factor->size);
  dvi__emit_number(out, factor->mass);
  if (factor->inertia != NULL)
    dvi__emit(out, ", .inertia = dvi_row_%d", dvi__emit_doubles(out, 9, factor->inertia));
  if (factor->centre != NULL)
    dvi__emit(out, ", .centre = dvi_row_%d", dvi__emit_doubles(out, 3, factor->centre));
  dvi__emit(out, "},\n");
}

static void emit_factors(dvi__emitter *out, const dvi_system_terms *terms)
{
  if (terms->factor_count == 0) return;
  dvi__emit(out, "  const dvi_factor factors[] = {\n");
  for (int k = 0; k < terms->factor_count; k++) emit_factor(out, &terms->factors[k]);
  dvi__emit(out, "  };\n  terms.factors = factors;\n  terms.factor_count = %d;\n",
            terms->factor_count);
}

/* Write the joints of bodies, which are made once and serve every system. */
static void emit_joints(dvi__emitter *out, const dvi_scene *scene, const char *name)
{
  const int functions = holonomic_functions(scene);
  if (scene->joint_count == 0) {
    emit_term_list(out, "dvi_holonomic", "holonomic", "holonomics", functions);
    return;
  }
  dvi__emit_joint_lists(out, scene);
  dvi__emit(out,
            "  static dvi_joints *joints = NULL; /* made once, for every system */\n"
            "  const dvi_status made = joints != NULL ? DVI_OK : dvi_joints_create(bodies, %d, "
            "joint, %d, %s_q, &joints);\n"
            "  if (made != DVI_OK) return made;\n  const dvi_holonomic holonomics[] = {",
            scene->body_count, scene->joint_count, name);
  for (int k = 0; k < functions; k++) dvi__emit(out, "holonomic_%d, ", k);
  dvi__emit(out,
            "*dvi_joints_constraints(joints)};\n  terms.holonomics = holonomics;\n"
            "  terms.holonomic_count = %d;\n",
            functions + 1);
}

static void emit_noise(dvi__emitter *out, const dvi_noise *noise)
{
  if (noise->function_count > 0) {
    dvi__emit(out, "  const dvi_potential noise_functions[] = {");
    for (int k = 0; k < noise->function_count; k++)
      dvi__emit(out, "%snoise_function_%d", k == 0 ? "" : ", ", k);
    dvi__emit(out, "};\n");
  }
  dvi__emit(out, "  const dvi_noise noise = {.temperature = ");
  dvi__emit_number(out, noise->temperature);
  dvi__emit(out, ", .friction = ");
  dvi__emit_number(out, noise->friction);
  dvi__emit(out, ", .seed = %lluu, .stream = %uu", noise->seed, noise->stream);
  if (noise->function_count > 0)
    dvi__emit(out, ", .functions = noise_functions, .function_count = %d", noise->function_count);
  dvi__emit(out, "};\n  terms.noise = &noise;\n");
}

static void emit_create(dvi__emitter *out, const dvi_scene *scene, const char *name)
{
  const dvi_system_terms *terms = &scene->terms;
  const dvi_mass *mass = &terms->mass;
  int pattern[2] = {-1, -1}, row = -1;
  if (mass->diagonal != NULL) row = dvi__emit_doubles(out, scene->n, mass->diagonal);
  if (mass->values != NULL) {
    dvi__emit_pattern_arrays(out, scene->n, &mass->pattern, pattern);
    row = dvi__emit_doubles(
        out, mass->pattern.start == NULL ? scene->n * scene->n : mass->pattern.start[scene->n],
        mass->values);
  }
  emit_inertias(out, terms);
  dvi__emit(out,
            "dvi_status %s_create(dvi_system **system)\n{\n  dvi_system_terms terms = {.dimension "
            "= %d, .autonomous = %d};\n",
            name, terms->dimension, terms->autonomous);
  emit_factors(out, terms);
  emit_term_list(out, "dvi_potential", "potential", "potentials", terms->potential_count);
  emit_term_list(out, "dvi_force", "force", "forces", terms->force_count);
  emit_joints(out, scene, name);
  emit_term_list(out, "dvi_nonholonomic", "nonholonomic", "nonholonomics",
                 terms->nonholonomic_count);
  emit_term_list(out, "dvi_symmetry", "symmetry", "symmetries", terms->symmetry_count);
  emit_term_list(out, "dvi_invariant", "invariant", "invariants", terms->invariant_count);
  if (terms->lagrangian != NULL) dvi__emit(out, "  terms.lagrangian = &lagrangian;\n");
  if (terms->one_form != NULL) dvi__emit(out, "  terms.one_form = &one_form;\n");
  if (terms->vector_potential != NULL)
    dvi__emit(out, "  terms.vector_potential = &vector_potential;\n");
  if (terms->hamiltonian != NULL) dvi__emit(out, "  terms.hamiltonian = &hamiltonian;\n");
  if (terms->constraint != NULL) dvi__emit(out, "  terms.constraint = &constraint;\n");
  if (terms->damping > 0) {
    dvi__emit(out, "  terms.damping = ");
    dvi__emit_number(out, terms->damping);
    dvi__emit(out, ";\n");
  }
  if (terms->noise != NULL) emit_noise(out, terms->noise);
  emit_mass(out, mass, pattern, row);
  dvi__emit(out, "  return dvi_system_create(&terms, system);\n}\n");
}

/* ---- start and plan ---- */

static void emit_start(dvi__emitter *out, const char *name, const char *letter, int n,
                       const double *x)
{
  dvi__emit(out, "\nconst double %s_%s[%d] = {\n", name, letter, n);
  for (int i = 0; i < n; i++) {
    dvi__emit(out, "    ");
    dvi__emit_number(out, x[i]);
    dvi__emit(out, ",\n");
  }
  dvi__emit(out, "};\n");
}

static void emit_events(dvi__emitter *out, const dvi_scene *scene, const char *name)
{
  if (scene->event_count == 0) return;
  dvi__emit(out, "\nconst dvi_event %s_events[%d] = {\n", name, scene->event_count);
  for (int k = 0; k < scene->event_count; k++) {
    const dvi__emitted_term term = dvi__event_term(scene, k);
    dvi__emit(out, "    {");
    dvi__emit_fields(out, &term);
    dvi__emit(out, ", .direction = %d, .terminal = %d},\n", scene->event[k].direction,
              scene->event[k].terminal);
  }
  dvi__emit(out, "};\n");
}

static void emit_number(dvi__emitter *out, const char *name, const char *letter, double value)
{
  dvi__emit(out, "const double %s_%s = ", name, letter);
  dvi__emit_number(out, value);
  dvi__emit(out, ";\n");
}

static void emit_plan(dvi__emitter *out, const dvi_scene *scene, const char *name)
{
  dvi__emit(out, "\n");
  if (scene->plan.method != NULL) {
    dvi__emit(out, "const char %s_method[] = ", name);
    dvi__emit_text(out, scene->plan.method);
    dvi__emit(out, ";\n");
  }
  emit_number(out, name, "h", scene->plan.h);
  emit_number(out, name, "t_end", scene->plan.t_end);
  emit_events(out, scene, name);
}

static const char *const run[] = {
    "  dvi_system *system = NULL;\n  dvi_integrator *integrator = NULL;\n",
    "  if (status == DVI_OK) status = dvi_run(integrator, &options, NULL);\n"
    "  if (status != DVI_OK) (void)fprintf(stderr, \"%s\\n\", dvi_last_error());\n"
    "  if (status == DVI_OK) printf(\"%.17g\", dvi_integrator_time(integrator));\n",
    "  if (status == DVI_OK) printf(\"\\n\");\n"
    "  dvi_integrator_destroy(&integrator);\n  dvi_system_destroy(&system);\n"
    "  return status == DVI_OK ? 0 : 1;\n}\n#endif\n",
};

static void emit_main(dvi__emitter *out, const dvi_scene *scene, const char *name)
{
  dvi__emit(out, "\n#ifdef DVI_MAIN\n/* Run it as the scene says, and print the last time, "
                 "coordinates and momenta. */\n#include <stdio.h>\n");
  dvi__emit(out, "int main(void)\n{\n%s", run[0]);
  dvi__emit(out, "  const dvi_run_options options = {.h = %s_h, .t_end = %s_t_end", name, name);
  if (scene->event_count > 0)
    dvi__emit(out, ", .events = %s_events, .event_count = %d", name, scene->event_count);
  dvi__emit(out, "};\n  dvi_status status = %s_create(&system);\n", name);
  dvi__emit(
      out,
      "  if (status == DVI_OK) status = dvi_integrator_create(system, %s_method, &integrator);\n",
      name);
  dvi__emit(
      out,
      "  if (status == DVI_OK) status = dvi_integrator_start(integrator, 0.0, %s_q, %s_p);\n%s",
      name, name, run[1]);
  for (const char *x = "qp"; *x != '\0'; x++)
    dvi__emit(out,
              "  for (int i = 0; status == DVI_OK && i < %d; i++) printf(\",%%.17g\", "
              "dvi_integrator_%c(integrator)[i]);\n",
              *x == 'q' ? scene->n : scene->nv, *x);
  dvi__emit(out, "%s", run[2]);
}

/* Test for forces that are given by coordinate, and not by a dissipation. */
static int has_force_of_coordinates(const dvi_system_terms *terms)
{
  for (int k = 0; k < terms->force_count; k++)
    if (terms->forces[k].value != NULL) return 1;
  return 0;
}

/* Write the declarations for a caller, and the zeros at which functions that are linear in w are
 * evaluated. */
static void emit_header(dvi__emitter *out, const dvi_scene *scene, const char *name)
{
  const dvi_system_terms *terms = &scene->terms;
  dvi__emit_begin(out);
  dvi__emit(out,
            "#include <dvi/dvi.h>\n\n/* The system, and its start; how it wants to be run. */\n");
  dvi__emit(out, "dvi_status %s_create(dvi_system **system);\n", name);
  dvi__emit(out, "extern const double %s_q[%d], %s_v[%d], %s_p[%d];\n", name, scene->n, name,
            scene->nv, name, scene->nv);
  if (scene->plan.method != NULL) dvi__emit(out, "extern const char %s_method[];\n", name);
  dvi__emit(out, "extern const double %s_h, %s_t_end;\n", name, name);
  if (scene->event_count > 0)
    dvi__emit(out, "extern const dvi_event %s_events[%d];\n", name, scene->event_count);
  dvi__emit(out, "\n");
  if (terms->one_form != NULL || terms->symmetry_count > 0 || terms->constraint != NULL ||
      holonomic_functions(scene) > 0 || terms->nonholonomic_count > 0 ||
      has_force_of_coordinates(terms))
    dvi__emit(out, "static const double dvi_zeros[%d] = {0};\n\n", 2 * scene->n);
}

/* Return DVI_UNSUPPORTED if the method runs the scene, but not a system without Taylor
 * coefficients, as the file's is. */
static dvi_status check_method(const dvi_scene *scene)
{
  dvi_system_terms terms = scene->terms;
  dvi_lagrangian lagrangian = scene->lagrangian;
  dvi_potential *potential = dvi__heap_take((size_t)terms.potential_count + 1, sizeof *potential);
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  if (potential == NULL) return DVI_NO_MEMORY;
  for (int k = 0; k < terms.potential_count; k++) {
    potential[k] = terms.potentials[k];
    potential[k].taylor = NULL;
  }
  lagrangian.taylor = NULL;
  if (terms.potential_count > 0) terms.potentials = potential;
  if (terms.lagrangian != NULL) terms.lagrangian = &lagrangian;
  dvi_status status = dvi_system_create(&terms, &system);
  if (status == DVI_OK) status = dvi_integrator_create(system, scene->plan.method, &integrator);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  dvi__heap_free(potential);
  if (status == DVI_UNSUPPORTED &&
      dvi_integrator_create(scene->system, scene->plan.method, &integrator) != DVI_OK)
    status = DVI_OK;
  dvi_integrator_destroy(&integrator);
  return status == DVI_UNSUPPORTED || status == DVI_NO_MEMORY ? status : DVI_OK;
}

dvi_status dvi_scene_emit_c(const dvi_scene *scene, const char *name,
                            int (*write)(const char *text, size_t size, void *user), void *user)
{
  if (scene == NULL || name == NULL || write == NULL) return DVI_BAD_ARGUMENT;
  if (!dvi__is_identifier(name) || strlen(name) > IDENTIFIER_MAX) return DVI_BAD_ARGUMENT;
  if (scene->control_count > 0 || scene->field != NULL || scene->density != NULL)
    return DVI_UNSUPPORTED;
  if (scene->terms.contact_count > 0) return DVI_UNSUPPORTED;
  dvi_status status = scene->plan.method != NULL ? check_method(scene) : DVI_OK;
  if (status != DVI_OK) return status;
  dvi__emitter out = {.write = write, .user = user};
  emit_header(&out, scene, name);
  status = emit_motion(&out, scene);
  if (status == DVI_OK) status = emit_watched(&out, scene);
  if (status == DVI_OK) {
    emit_create(&out, scene, name);
    emit_start(&out, name, "q", scene->n, scene->q);
    emit_start(&out, name, "v", scene->nv, scene->v);
    emit_start(&out, name, "p", scene->nv, scene->p);
    emit_plan(&out, scene, name);
    if (scene->plan.method != NULL) emit_main(&out, scene, name);
  }
  const dvi_status ended = dvi__emit_end(&out);
  return status != DVI_OK ? status : ended;
}
