/* Programs as C. Each instruction is a line or a few, and each result a new name. */
#include <math.h>
#include <stddef.h>

#include "scene/emit/emit_parts.h"
#include "expr/compile/program_codes.h"

typedef struct emission {
  dvi__emitter *out;
  const char *indent;
  int *name, *next, rows; /* name [rows] of registers, then of inputs */
} emission;

static int name_of_row(const emission *e, int row)
{
  return row >= 0 ? e->name[row] : e->name[e->rows + ~row];
}

/* Return an operation in C, with operands a, b and c and the value v. NULL for a function, or for
 * more than a line. */
static const char *formula_of(int op)
{
  switch (op) {
  case DVI__CODE_FILL: return "v";
  case DVI__CODE_ADD_VALUE: return "a + v";
  case DVI__CODE_SUBTRACT_FROM: return "v - a";
  case DVI__CODE_MULTIPLY_BY: return "a * v";
  case DVI__CODE_DIVIDE_BY: return "a / v";
  case DVI__CODE_DIVIDE_INTO: return "v / a";
  case DVI__CODE_MULTIPLY_ADD: return "a * b + c";
  case DVI__CODE_MULTIPLY_LESS: return "a * b - c";
  case DVI__CODE_LESS_PRODUCT: return "c - a * b";
  case DVI__OP_ADD: return "a + b";
  case DVI__OP_SUBTRACT: return "a - b";
  case DVI__OP_MULTIPLY: return "a * b";
  case DVI__OP_DIVIDE: return "a / b";
  case DVI__OP_NEGATE: return "-a";
  case DVI__OP_SQUARE: return "a * a";
  case DVI__OP_POSITIVE: return "a > 0.0 ? 1.0 : a <= 0.0 ? 0.0 : a";
  case DVI__OP_WHERE: return "a > 0.0 ? b : a <= 0.0 ? 0.0 : a";
  case DVI__OP_SIGN: return "a > 0.0 ? 1.0 : a < 0.0 ? -1.0 : a";
  default: return NULL;
  }
}

static const char *function_of(int op)
{
#define SPELLING(name, operands, spelling) spelling,
  static const char *const spelling[] = {DVI__OP_LIST(SPELLING)};
#undef SPELLING
  return spelling[op];
}

/* Begin a line that defines a new name. */
static int begin_definition(const emission *e)
{
  dvi__emit(e->out, "%sconst double r%d = ", e->indent, *e->next);
  return (*e->next)++;
}

static int emit_formula(const emission *e, const dvi__instruction *at, const char *formula)
{
  const int made = begin_definition(e);
  for (const char *c = formula; *c != '\0'; c++)
    if (*c == 'v')
      dvi__emit_number(e->out, at->value);
    else if (*c == 'a')
      dvi__emit(e->out, "r%d", name_of_row(e, at->a));
    else if (*c == 'b')
      dvi__emit(e->out, "r%d", name_of_row(e, at->b));
    else if (*c == 'c')
      dvi__emit(e->out, "r%d", name_of_row(e, at->c));
    else
      dvi__emit(e->out, "%c", *c);
  dvi__emit(e->out, ";\n");
  return made;
}

static int emit_math_function(const emission *e, const dvi__instruction *at)
{
  const int two = at->op == DVI__OP_RAISE || at->op == DVI__OP_ATAN2;
  const int made = begin_definition(e);
  dvi__emit(e->out, "%s(r%d", function_of(at->op), name_of_row(e, at->a));
  if (two) dvi__emit(e->out, ", r%d", name_of_row(e, at->b));
  dvi__emit(e->out, ");\n");
  return made;
}

static int emit_product(const emission *e, int a, int b)
{
  const int made = begin_definition(e);
  dvi__emit(e->out, "r%d * r%d;\n", a, b);
  return made;
}

/* Write a^n by squares of squares, from the lowest bit of n on. */
static int emit_whole_power(const emission *e, const dvi__instruction *at)
{
  int base = name_of_row(e, at->a), product = -1;
  for (unsigned left = (unsigned)fabs(at->value); left != 0; left /= 2) {
    if (left % 2 != 0) product = product < 0 ? base : emit_product(e, product, base);
    if (left > 1) base = emit_product(e, base, base);
  }
  if (at->value > 0) return product;
  const int made = begin_definition(e);
  dvi__emit(e->out, "1.0 / r%d;\n", product);
  return made;
}

/* Write the root of a, or one over it, times whole powers. */
static int emit_half_power(const emission *e, const dvi__instruction *at)
{
  const int a = name_of_row(e, at->a), inverse = at->op == DVI__CODE_INVERSE_ROOT_POWER;
  int product = begin_definition(e), factor = a;
  if (inverse)
    dvi__emit(e->out, "dvi_inverse_root(careful, r%d, &unusual);\n", a);
  else
    dvi__emit(e->out, "sqrt(r%d);\n", a);
  const int factors = (int)fabs(at->value);
  if (inverse && factors > 0) factor = emit_product(e, product, product);
  for (int i = 0; i < factors; i++) product = emit_product(e, product, factor);
  return product;
}

static void emit_sine_and_cosine(const emission *e, const dvi__instruction *at)
{
  const int angle = name_of_row(e, at->a);
  e->name[at->to] = begin_definition(e);
  dvi__emit(e->out, "dvi_sin(r%d);\n", angle);
  e->name[at->b] = begin_definition(e);
  dvi__emit(e->out, "dvi_cos(r%d);\n", angle);
}

static int emit_instruction(const emission *e, const dvi__instruction *at)
{
  const char *formula = formula_of(at->op);
  if (formula != NULL) return emit_formula(e, at, formula);
  switch (at->op) {
  case DVI__CODE_COPY: return name_of_row(e, at->a);
  case DVI__CODE_WHOLE_POWER: return emit_whole_power(e, at);
  case DVI__CODE_ROOT_POWER:
  case DVI__CODE_INVERSE_ROOT_POWER: return emit_half_power(e, at);
  default: return emit_math_function(e, at);
  }
}

void dvi__emit_program(dvi__emitter *out, const dvi__program *program, const char *indent,
                       int *name, int *next)
{
  const emission e = {out, indent, name, next, program->row_count};
  for (int i = 0; i < program->instruction_count; i++) {
    const dvi__instruction *at = &program->instruction[i];
    if (at->op == DVI__CODE_SINE_AND_COSINE)
      emit_sine_and_cosine(&e, at);
    else
      name[at->to] = emit_instruction(&e, at);
  }
}

int dvi__program_has_inverse_roots(const dvi__program *program)
{
  for (int i = 0; i < program->instruction_count; i++)
    if (program->instruction[i].op == DVI__CODE_INVERSE_ROOT_POWER) return 1;
  return 0;
}
