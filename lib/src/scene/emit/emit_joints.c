/* Joints as lists of bodies and of declarations. */
#include "scene/emit/emit_scene.h"

const char *dvi__factor_kind_name(dvi_factor_kind kind)
{
  static const char *const name[] = {[DVI_RN] = "DVI_RN",
                                     [DVI_SO3] = "DVI_SO3",
                                     [DVI_SE3] = "DVI_SE3",
                                     [DVI_S2] = "DVI_S2",
                                     [DVI_U1] = "DVI_U1"};
  return name[kind];
}

static void emit_vector(dvi__emitter *out, const char *member, const double *x)
{
  dvi__emit(out, ", .%s = {", member);
  for (int i = 0; i < 3; i++) {
    if (i > 0) dvi__emit(out, ", ");
    dvi__emit_number(out, x[i]);
  }
  dvi__emit(out, "}");
}

static void emit_joint(dvi__emitter *out, const dvi_joint *joint)
{
  static const char *const kind[] = {[DVI_BALL] = "DVI_BALL",           [DVI_HINGE] = "DVI_HINGE",
                                     [DVI_UNIVERSAL] = "DVI_UNIVERSAL", [DVI_SLIDER] = "DVI_SLIDER",
                                     [DVI_PLANAR] = "DVI_PLANAR",       [DVI_WELD] = "DVI_WELD",
                                     [DVI_DISTANCE] = "DVI_DISTANCE"};
  dvi__emit(out, "      {.name = ");
  dvi__emit_text(out, joint->name);
  dvi__emit(out, ", .kind = %s, .body = {%d, %d}", kind[joint->kind], joint->body[0],
            joint->body[1]);
  emit_vector(out, "at", joint->at);
  emit_vector(out, "to", joint->to);
  emit_vector(out, "axis", joint->axis);
  emit_vector(out, "second_axis", joint->second_axis);
  dvi__emit(out, "},\n");
}

void dvi__emit_joint_lists(dvi__emitter *out, const dvi_scene *scene)
{
  dvi__emit(out, "  static const dvi_factor bodies[] = {\n");
  for (int k = 0; k < scene->body_count; k++)
    dvi__emit(out, "      {.kind = %s, .size = %d},\n", dvi__factor_kind_name(scene->body[k].kind),
              scene->body[k].size);
  dvi__emit(out, "  };\n  static const dvi_joint joint[] = {\n");
  for (int k = 0; k < scene->joint_count; k++) emit_joint(out, &scene->joint[k]);
  dvi__emit(out, "  };\n");
}
