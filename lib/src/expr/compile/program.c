/* Compilation. It finds which nodes are needed, which of them share one instruction, and in which
 * registers results are kept. */
#include "expr/compile/program.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "text/heap.h"
#include "expr/compile/program_codes.h"

enum { NOWHERE = INT_MAX };

typedef struct compiler {
  const dvi__graph *graph;
  dvi__program *program;
  int count;       /* nodes up to the last root */
  int *uses;       /* uses of each node that are still to come */
  int *row;        /* row that holds each node, or NOWHERE */
  int *mate;       /* cosine of each sine's angle, and the reverse, else -1 */
  int *first_root; /* first output that each node is, or -1 */
  int *next_root;  /* next output of the same node, or -1 */
  int *free_register, free_count, register_count;
  char *is_input, *joined; /* a joined product is computed where it is added */
  dvi_status failed;
} compiler;

static const dvi__graph_node *compiler_node(const compiler *c, dvi__node n)
{
  return &c->graph->node[n];
}

static int compiler_is_constant(const compiler *c, dvi__node n)
{
  return compiler_node(c, n)->op == DVI__OP_CONSTANT;
}

static int operands_of_op(dvi__op op)
{
  static const signed char count[DVI__OP_COUNT] = {
#define DVI__OP_OPERANDS(name, operands, spelling) operands,
      DVI__OP_LIST(DVI__OP_OPERANDS)
#undef DVI__OP_OPERANDS
  };
  return count[op];
}

/* ---- needed nodes ---- */

/* Count the uses of nodes by others that are needed. Returns how many are needed. */
static int count_uses(compiler *c, int root_count, const dvi__node *root)
{
  int needed = 0;
  for (int k = 0; k < root_count; k++) c->uses[root[k]]++;
  for (dvi__node n = c->count - 1; n >= 0; n--) {
    if (c->uses[n] == 0) continue;
    needed++;
    const dvi__graph_node *node = compiler_node(c, n);
    const int operands = c->is_input[n] ? 0 : operands_of_op(node->op);
    if (operands > 0) c->uses[node->a]++;
    if (operands > 1) c->uses[node->b]++;
    if (node->op == DVI__OP_INPUT && !c->is_input[n]) c->failed = DVI_BAD_ARGUMENT;
  }
  return needed;
}

/* Return the second factor of a product, or of a square. */
static dvi__node second_factor(const dvi__graph_node *node)
{
  return node->op == DVI__OP_SQUARE ? node->a : node->b;
}

/* Return 1 if a product can be computed in the sum that uses it. It must be used once and have two
 * variable factors. */
static int product_joins_sum(const compiler *c, dvi__node product, dvi__node other)
{
  const dvi__graph_node *node = compiler_node(c, product);
  return (node->op == DVI__OP_MULTIPLY || node->op == DVI__OP_SQUARE) && c->uses[product] == 1 &&
         !c->is_input[product] && product != other && !compiler_is_constant(c, node->a) &&
         !compiler_is_constant(c, second_factor(node)) && !compiler_is_constant(c, other);
}

/* Pair a sine and a cosine of the same angle. `seen` [count] is filled with -1. */
static void pair_up(compiler *c, dvi__node n, int *seen)
{
  const dvi__node angle = compiler_node(c, n)->a, other = seen[angle];
  seen[angle] = n;
  if (other < 0) return;
  c->mate[n] = other;
  c->mate[other] = n;
}

static void find_joined(compiler *c, int *seen)
{
  for (dvi__node n = 0; n < c->count; n++) {
    const dvi__graph_node *node = compiler_node(c, n);
    if (c->uses[n] == 0 || c->is_input[n]) continue;
    if (node->op == DVI__OP_SIN || node->op == DVI__OP_COS) pair_up(c, n, seen);
    if (node->op != DVI__OP_ADD && node->op != DVI__OP_SUBTRACT) continue;
    if (product_joins_sum(c, node->a, node->b))
      c->joined[node->a] = 1;
    else if (product_joins_sum(c, node->b, node->a))
      c->joined[node->b] = 1;
  }
}

/* ---- registers ---- */

static int take_register(compiler *c)
{
  return c->free_count > 0 ? c->free_register[--c->free_count] : c->register_count++;
}

static void release_node(compiler *c, dvi__node n)
{
  if (--c->uses[n] == 0 && c->row[n] >= 0 && c->row[n] != NOWHERE)
    c->free_register[c->free_count++] = c->row[n];
}

static void release_operands(compiler *c, dvi__node n)
{
  const dvi__graph_node *node = compiler_node(c, n);
  const int operands = operands_of_op(node->op);
  const dvi__node operand[2] = {node->a, node->b};
  for (int i = 0; i < 2 && i < operands; i++)
    if (c->joined[operand[i]]) {
      release_node(c, compiler_node(c, operand[i])->a);
      if (compiler_node(c, operand[i])->op == DVI__OP_MULTIPLY)
        release_node(c, compiler_node(c, operand[i])->b);
    } else {
      release_node(c, operand[i]);
    }
}

static void append_instruction(compiler *c, dvi__instruction instruction)
{
  c->program->instruction[c->program->instruction_count++] = instruction;
}

/* Return the row of an operand. A constant is put into a row when it is first asked for. */
static int operand_row(compiler *c, dvi__node n)
{
  if (c->row[n] == NOWHERE) {
    c->row[n] = take_register(c);
    append_instruction(c, (dvi__instruction){.op = DVI__CODE_FILL,
                                             .to = c->row[n],
                                             .value = compiler_node(c, n)->value});
  }
  return c->row[n];
}

/* ---- instructions ---- */

static int power_code(double exponent)
{
  if (exponent == floor(exponent)) return DVI__CODE_WHOLE_POWER;
  return exponent > 0.0 ? DVI__CODE_ROOT_POWER : DVI__CODE_INVERSE_ROOT_POWER;
}

static dvi__instruction product_instruction(compiler *c, dvi__code code, dvi__node product,
                                            dvi__node other)
{
  const dvi__graph_node *node = compiler_node(c, product);
  return (dvi__instruction){.op = (int)code,
                            .a = operand_row(c, node->a),
                            .b = operand_row(c, second_factor(node)),
                            .c = operand_row(c, other)};
}

static dvi__instruction value_instruction(compiler *c, dvi__code code, dvi__node a, double value)
{
  return (dvi__instruction){.op = (int)code, .a = operand_row(c, a), .value = value};
}

static dvi__instruction sum_instruction(compiler *c, const dvi__graph_node *node)
{
  double value = 0.0;
  if (c->joined[node->a]) return product_instruction(c, DVI__CODE_MULTIPLY_ADD, node->a, node->b);
  if (c->joined[node->b]) return product_instruction(c, DVI__CODE_MULTIPLY_ADD, node->b, node->a);
  if (dvi__is_constant(c->graph, node->a, &value))
    return value_instruction(c, DVI__CODE_ADD_VALUE, node->b, value);
  if (dvi__is_constant(c->graph, node->b, &value))
    return value_instruction(c, DVI__CODE_ADD_VALUE, node->a, value);
  return (dvi__instruction){
      .op = DVI__OP_ADD, .a = operand_row(c, node->a), .b = operand_row(c, node->b)};
}

static dvi__instruction difference_instruction(compiler *c, const dvi__graph_node *node)
{
  double value = 0.0;
  if (c->joined[node->a]) return product_instruction(c, DVI__CODE_MULTIPLY_LESS, node->a, node->b);
  if (c->joined[node->b]) return product_instruction(c, DVI__CODE_LESS_PRODUCT, node->b, node->a);
  if (dvi__is_constant(c->graph, node->a, &value))
    return value_instruction(c, DVI__CODE_SUBTRACT_FROM, node->b, value);
  if (dvi__is_constant(c->graph, node->b, &value))
    return value_instruction(c, DVI__CODE_ADD_VALUE, node->a, -value);
  return (dvi__instruction){
      .op = DVI__OP_SUBTRACT, .a = operand_row(c, node->a), .b = operand_row(c, node->b)};
}

/* Make the instruction that computes node n, without its destination. */
static dvi__instruction instruction_of(compiler *c, dvi__node n)
{
  const dvi__graph_node *node = compiler_node(c, n);
  double value = 0.0;
  if (node->op == DVI__OP_ADD) return sum_instruction(c, node);
  if (node->op == DVI__OP_SUBTRACT) return difference_instruction(c, node);
  if (node->op == DVI__OP_MULTIPLY && dvi__is_constant(c->graph, node->a, &value))
    return value_instruction(c, DVI__CODE_MULTIPLY_BY, node->b, value);
  if (node->op == DVI__OP_MULTIPLY && dvi__is_constant(c->graph, node->b, &value))
    return value_instruction(c, DVI__CODE_MULTIPLY_BY, node->a, value);
  if (node->op == DVI__OP_DIVIDE && dvi__is_constant(c->graph, node->a, &value))
    return value_instruction(c, DVI__CODE_DIVIDE_INTO, node->b, value);
  if (node->op == DVI__OP_DIVIDE && dvi__is_constant(c->graph, node->b, &value))
    return value_instruction(c, DVI__CODE_DIVIDE_BY, node->a, value);
  dvi__instruction plain = {
      .op = (int)node->op, .a = operand_row(c, node->a), .value = node->value};
  if (node->op == DVI__OP_POWER) plain.op = power_code(node->value);
  if (operands_of_op(node->op) > 1) plain.b = operand_row(c, node->b);
  return plain;
}

/* Return a preliminary number for the row of output k. Outputs are numbered when all registers
 * are. */
static int output_row(int k)
{
  return INT_MIN + k;
}

/* Choose the destination of node n. It is the node's output, if there is one, or else a
 * register. */
static int choose_destination(compiler *c, dvi__node n)
{
  c->row[n] = c->first_root[n] >= 0 ? output_row(c->first_root[n]) : take_register(c);
  return c->row[n];
}

static void emit_node(compiler *c, dvi__node n)
{
  const dvi__node mate = c->mate[n];
  if (mate >= 0 && mate < n) { /* computed with its mate */
    release_operands(c, n);
    return;
  }
  dvi__instruction instruction = instruction_of(c, n);
  instruction.to = choose_destination(c, n);
  if (mate >= 0) {
    const int other = choose_destination(c, mate), is_sine = compiler_node(c, n)->op == DVI__OP_SIN;
    instruction.op = DVI__CODE_SINE_AND_COSINE;
    instruction.b = is_sine ? other : instruction.to;
    instruction.to = is_sine ? instruction.to : other;
  }
  append_instruction(c, instruction);
  release_operands(c, n);
}

/* Copy node n to all its outputs but the one where it was computed. */
static void write_roots(compiler *c, dvi__node n)
{
  for (int k = c->first_root[n]; k >= 0; k = c->next_root[k]) {
    if (compiler_is_constant(c, n))
      append_instruction(c, (dvi__instruction){.op = DVI__CODE_FILL,
                                               .to = output_row(k),
                                               .value = compiler_node(c, n)->value});
    else if (c->row[n] != output_row(k))
      append_instruction(
          c, (dvi__instruction){.op = DVI__CODE_COPY, .to = output_row(k), .a = c->row[n]});
    release_node(c, n);
  }
}

static void emit_nodes(compiler *c)
{
  for (dvi__node n = 0; n < c->count; n++) {
    if (c->uses[n] == 0 || c->joined[n]) continue;
    if (!c->is_input[n] && compiler_node(c, n)->op != DVI__OP_CONSTANT) emit_node(c, n);
    write_roots(c, n);
  }
}

/* Number outputs after the registers. */
static void number_outputs(compiler *c, int root_count)
{
  dvi__program *program = c->program;
  program->row_count = c->register_count + root_count;
  for (int i = 0; i < program->instruction_count; i++) {
    dvi__instruction *at = &program->instruction[i];
    int *const row[] = {&at->to, &at->a, &at->b, &at->c};
    for (int r = 0; r < 4; r++)
      if (*row[r] < INT_MIN + root_count) *row[r] = c->register_count + (*row[r] - INT_MIN);
  }
}

/* ---- memory ---- */

static int *filled_array(int count, int value)
{
  int *made = dvi__heap_take((size_t)count + 1, sizeof *made);
  for (int i = 0; made != NULL && i < count; i++) made[i] = value;
  return made;
}

static dvi_status compiler_allocate(compiler *c, int root_count)
{
  c->uses = dvi__heap_take((size_t)c->count + 1, sizeof *c->uses);
  c->row = filled_array(c->count, NOWHERE);
  c->mate = filled_array(c->count, -1);
  c->first_root = filled_array(c->count, -1);
  c->next_root = filled_array(root_count, -1);
  c->is_input = dvi__heap_take((size_t)c->count + 1, 2);
  c->free_register = filled_array(c->count, -1);
  if (!c->uses || !c->row || !c->mate || !c->first_root || !c->next_root || !c->is_input ||
      !c->free_register)
    return DVI_NO_MEMORY;
  c->joined = c->is_input + c->count;
  return DVI_OK;
}

static void compiler_clear(compiler *c)
{
  dvi__heap_free(c->uses);
  dvi__heap_free(c->row);
  dvi__heap_free(c->mate);
  dvi__heap_free(c->first_root);
  dvi__heap_free(c->next_root);
  dvi__heap_free(c->is_input);
  dvi__heap_free(c->free_register);
}

static dvi_status compiler_run(compiler *c, int input_count, const dvi__node *input, int root_count,
                               const dvi__node *root)
{
  dvi_status status = compiler_allocate(c, root_count);
  if (status != DVI_OK) return status;
  for (int i = 0; i < input_count; i++) {
    c->is_input[input[i]] = 1;
    c->row[input[i]] = ~i;
  }
  for (int k = root_count - 1; k >= 0; k--) {
    c->next_root[k] = c->first_root[root[k]];
    c->first_root[root[k]] = k;
  }
  const size_t needed = (size_t)count_uses(c, root_count, root);
  if (c->failed != DVI_OK) return c->failed;
  c->program->instruction = dvi__heap_take(needed + (size_t)root_count + 1,
                                           sizeof *c->program->instruction);
  if (c->program->instruction == NULL) return DVI_NO_MEMORY;
  find_joined(c, c->free_register); /* no register is free yet */
  emit_nodes(c);
  number_outputs(c, root_count);
  return c->program->row_count + input_count > DVI__ROWS_MAX ? DVI_BAD_SIZE : DVI_OK;
}

dvi_status dvi__program_make(const dvi__graph *graph, int input_count, const dvi__node *input,
                             int root_count, const dvi__node *root, dvi__program *program)
{
  *program = (dvi__program){.input_count = input_count, .output_count = root_count};
  compiler c = {.graph = graph, .program = program};
  for (int k = 0; k < root_count; k++)
    if (root[k] >= c.count) c.count = root[k] + 1;
  for (int i = 0; i < input_count; i++)
    if (input[i] >= c.count) c.count = input[i] + 1;
  const dvi_status status = compiler_run(&c, input_count, input, root_count, root);
  compiler_clear(&c);
  if (status != DVI_OK) dvi__program_free(program);
  return status;
}

void dvi__program_free(dvi__program *program)
{
  dvi__heap_free(program->instruction);
  *program = (dvi__program){0};
}

int dvi__program_operations(const dvi__program *program)
{
  int operations = 0;
  for (int i = 0; i < program->instruction_count; i++) {
    const int op = program->instruction[i].op;
    if (op == DVI__CODE_COPY || op == DVI__CODE_FILL) continue;
    operations += op == DVI__CODE_MULTIPLY_ADD || op == DVI__CODE_MULTIPLY_LESS ||
                          op == DVI__CODE_LESS_PRODUCT || op == DVI__CODE_SINE_AND_COSINE
                      ? 2
                      : 1;
  }
  return operations;
}
