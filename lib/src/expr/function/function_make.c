/* Parts of sums. A part has the program of a kernel's roots, the places of the variables that it
 * reads, and columns. A column holds a node that depends on no variable, computed once for every
 * element. */
#include <limits.h>
#include <string.h>

#include "expr/function/function_parts.h"
#include "text/heap.h"

/* Marks of a kernel's nodes for the roots of a part. */
enum { NEEDED = 1, VARIES = 2 };

typedef struct maker {
  dvi__function *function;
  const dvi__kernel *kernel;
  dvi__derivatives *derivatives;
  dvi__part *part;
  int count;             /* nodes up to the last root */
  unsigned char *mark;   /* [count] */
  dvi__node *input_node; /* [count] nodes that the program reads, variables before columns */
} maker;

static const dvi__graph_node *maker_node(const maker *m, dvi__node n)
{
  return &m->kernel->graph->node[n];
}

static int operand_count_of(dvi__op op)
{
  return op <= DVI__OP_INPUT ? 0 : op < DVI__OP_ADD ? 1 : 2;
}

static int maker_is_constant(const maker *m, dvi__node n)
{
  return maker_node(m, n)->op == DVI__OP_CONSTANT;
}

static void mark_varying(maker *m)
{
  for (dvi__node n = 0; n < m->count; n++) {
    const dvi__graph_node *node = maker_node(m, n);
    const int count = operand_count_of(node->op);
    int varies = node->op == DVI__OP_INPUT && !m->kernel->input[node->a].is_data;
    varies |= count > 0 && (m->mark[node->a] & VARIES) != 0;
    varies |= count > 1 && (m->mark[node->b] & VARIES) != 0;
    if (varies) m->mark[n] |= VARIES;
  }
}

/* Return 1 if a node takes one operation on a column. It is computed each time, since reading
 * another column would take longer. */
static int is_cheap(const maker *m, const dvi__graph_node *node)
{
  if (node->op == DVI__OP_NEGATE || node->op == DVI__OP_SQUARE) return 1;
  if (node->op != DVI__OP_ADD && node->op != DVI__OP_SUBTRACT && node->op != DVI__OP_MULTIPLY)
    return 0;
  return maker_is_constant(m, node->a) || maker_is_constant(m, node->b);
}

/* Return 1 if a node is read from a column. */
static int is_column(const maker *m, dvi__node n)
{
  const dvi__graph_node *node = maker_node(m, n);
  return (m->mark[n] & VARIES) == 0 && node->op != DVI__OP_CONSTANT && !is_cheap(m, node);
}

/* Collect the nodes that the program reads, first variables, then columns. */
static void maker_collect(maker *m, int root_count, const dvi__node *root)
{
  int columns = 0, at = m->count;
  for (int k = 0; k < root_count; k++) m->mark[root[k]] |= NEEDED;
  for (dvi__node n = m->count - 1; n >= 0; n--) {
    if ((m->mark[n] & NEEDED) == 0) continue;
    const dvi__graph_node *node = maker_node(m, n);
    const int count = operand_count_of(node->op);
    if (is_column(m, n)) {
      m->input_node[--at] = n;
      columns++;
    } else if (node->op == DVI__OP_INPUT) {
      m->input_node[m->part->variable_count++] = n;
    } else {
      if (count > 0) m->mark[node->a] |= NEEDED;
      if (count > 1) m->mark[node->b] |= NEEDED;
    }
  }
  memmove(m->input_node + m->part->variable_count, m->input_node + at,
          (size_t)columns * sizeof *m->input_node);
  m->part->column_count = columns;
}

/* ---- columns ---- */

static const double *known_column(const maker *m, dvi__node n)
{
  const dvi__graph_node *node = maker_node(m, n);
  if (node->op == DVI__OP_INPUT) return m->kernel->input[node->a].data;
  for (const dvi__column *column = m->derivatives->column; column != NULL; column = column->before)
    if (column->node == n) return column->value;
  return NULL;
}

/* Run a program of data inputs (nodes `data`) for all elements, a few at a time. Its outputs go to
 * columns. */
static dvi_status run_columns(const maker *m, const dvi__program *program, const dvi__node *data,
                              int count, double *const *column)
{
  const int width = DVI__LANES, inputs = program->input_count;
  double *rows = dvi__heap_take((size_t)program->row_count + (size_t)inputs,
                                (size_t)width * sizeof *rows);
  const double **input = dvi__heap_take((size_t)inputs + 1, sizeof *input);
  if (rows == NULL || input == NULL) {
    dvi__heap_free(rows);
    dvi__heap_free((void *)input);
    return DVI_NO_MEMORY;
  }
  for (int i = 0; i < inputs; i++) input[i] = rows + (ptrdiff_t)i * width;
  double *registers = rows + (ptrdiff_t)inputs * width;
  const double *outputs = registers + (ptrdiff_t)(program->row_count - count) * width;
  for (int first = 0; first < m->kernel->elements; first += width) {
    const int left = m->kernel->elements - first;
    for (int i = 0; i < inputs; i++)
      for (int k = 0; k < width; k++)
        rows[i * width + k] = m->kernel->input[maker_node(m, data[i])->a]
                                  .data[k < left ? first + k : m->kernel->elements - 1];
    dvi__program_run(program, width, input, registers);
    for (int c = 0; c < count; c++)
      memcpy(column[c] + first, outputs + (ptrdiff_t)c * width,
             (size_t)(left < width ? left : width) * sizeof **column);
  }
  dvi__heap_free(rows);
  dvi__heap_free((void *)input);
  return DVI_OK;
}

/* Register columns for nodes. */
static dvi_status keep_columns(maker *m, int count, const dvi__node *node, double **value)
{
  for (int c = 0; c < count; c++) {
    dvi__column *column = dvi__arena_take(&m->function->arena, 1, sizeof *column);
    value[c] = dvi__arena_take(&m->function->arena, (size_t)m->kernel->elements, sizeof **value);
    if (column == NULL || value[c] == NULL) return DVI_NO_MEMORY;
    *column = (dvi__column){.node = node[c], .value = value[c], .before = m->derivatives->column};
    m->derivatives->column = column;
  }
  return DVI_OK;
}

/* List the nodes of all data inputs up to the last root. Returns how many there are. */
static int data_nodes(const maker *m, dvi__node *data)
{
  int count = 0;
  for (dvi__node n = 0; n < m->count; n++)
    if (maker_node(m, n)->op == DVI__OP_INPUT && m->kernel->input[maker_node(m, n)->a].is_data)
      data[count++] = n;
  return count;
}

static dvi_status compute_columns(maker *m, int count, const dvi__node *node)
{
  dvi__node *data = dvi__heap_take((size_t)m->count + 1, sizeof *data);
  double **value = dvi__heap_take((size_t)count + 1, sizeof *value);
  dvi__program program = {0};
  dvi_status status = data != NULL && value != NULL ? DVI_OK : DVI_NO_MEMORY;
  if (status == DVI_OK)
    status = dvi__program_make(m->kernel->graph, data_nodes(m, data), data, count, node, &program);
  dvi__column *const before = m->derivatives->column;
  if (status == DVI_OK) status = keep_columns(m, count, node, value);
  if (status == DVI_OK) status = run_columns(m, &program, data, count, value);
  if (status != DVI_OK) m->derivatives->column = before;
  dvi__program_free(&program);
  dvi__heap_free((void *)value);
  dvi__heap_free(data);
  return status;
}

/* Compute the columns that are missing. */
static dvi_status make_columns(maker *m)
{
  const int count = m->part->column_count;
  const dvi__node *input_node = m->input_node + m->part->variable_count;
  dvi__node *missing = dvi__heap_take((size_t)count + 1, sizeof *missing);
  if (missing == NULL) return DVI_NO_MEMORY;
  int absent = 0;
  for (int c = 0; c < count; c++)
    if (known_column(m, input_node[c]) == NULL) missing[absent++] = input_node[c];
  const dvi_status status = absent > 0 ? compute_columns(m, absent, missing) : DVI_OK;
  dvi__heap_free(missing);
  return status;
}

/* ---- parts ---- */

static dvi_status point_at_rows(maker *m)
{
  dvi__part *part = m->part;
  part->block = dvi__arena_take(&m->function->arena, (size_t)part->variable_count,
                                sizeof *part->block);
  part->variable = dvi__arena_take(&m->function->arena, (size_t)part->variable_count,
                                   sizeof *part->variable);
  part->column = dvi__arena_take(&m->function->arena, (size_t)part->column_count,
                                 sizeof *part->column);
  if (part->block == NULL || part->variable == NULL || part->column == NULL) return DVI_NO_MEMORY;
  for (int i = 0; i < part->variable_count; i++) {
    const int input = maker_node(m, m->input_node[i])->a;
    part->block[i] = m->kernel->input[input].block;
    part->variable[i] = m->derivatives->place[input];
  }
  for (int c = 0; c < part->column_count; c++)
    part->column[c] = known_column(m, m->input_node[part->variable_count + c]);
  return DVI_OK;
}

static dvi_status maker_compile(maker *m, int root_count, const dvi__node *root)
{
  mark_varying(m);
  maker_collect(m, root_count, root);
  dvi_status status = make_columns(m);
  if (status != DVI_OK) return status;
  status = point_at_rows(m);
  if (status != DVI_OK) return status;
  status = dvi__program_make(m->kernel->graph, m->part->variable_count + m->part->column_count,
                             m->input_node, root_count, root, &m->part->program);
  return status == DVI_OK ? dvi__part_plan(m->part) : status;
}

dvi__function_sum *dvi__sum_new(dvi__function *function, int array_count)
{
  const size_t count = (size_t)array_count;
  dvi__function_sum *sum = dvi__arena_take(&function->arena, 1, sizeof *sum);
  char *flags = dvi__arena_take(&function->arena, 2 * count, sizeof *flags);
  int *size = dvi__arena_take(&function->arena, 2 * count, sizeof *size);
  if (sum == NULL || flags == NULL || size == NULL) return NULL;
  sum->array_count = array_count;
  sum->wanted = flags;
  sum->clear = flags + count;
  sum->size = size;
  sum->result = size + count;
  sum->before = function->last;
  function->last = sum;
  return sum;
}

/* Drop the sign of a root. */
static dvi__node without_sign(const maker *m, dvi__node root, int *negative)
{
  *negative = maker_node(m, root)->op == DVI__OP_NEGATE;
  return *negative ? maker_node(m, root)->a : root;
}

/* Point targets at outputs. Equal roots share one output. Leaves the different roots, without their
 * signs, in `root`. */
static dvi_status find_outputs(const maker *m, dvi__node *root, int *output_count)
{
  /* output of each node, plus 1 */
  int *output = dvi__heap_take((size_t)m->count + 1, sizeof *output);
  *output_count = 0;
  if (output == NULL) return DVI_NO_MEMORY;
  for (int k = 0; k < m->part->target_count; k++) {
    dvi__destination *target = &m->part->target[k];
    const dvi__node node = without_sign(m, root[k], &target->negative);
    if (output[node] == 0) {
      root[*output_count] = node;
      output[node] = ++*output_count;
    }
    target->output = output[node] - 1;
  }
  dvi__heap_free(output);
  return DVI_OK;
}

/* Return 1 if the next target is always added beside this one. */
static int is_beside(const dvi__destination *target)
{
  const dvi__element_places *own = &target[0].entry.minor, *next = &target[1].entry.minor;
  return target[0].entry.scale == 0 && target[1].entry.scale == 0 &&
         target[0].array == target[1].array && target[0].negative == target[1].negative &&
         !target[0].mirrored && !target[1].mirrored && own->list == next->list &&
         own->stride == next->stride && next->start == own->start + 1 &&
         target[1].output == target[0].output + 1;
}

static void find_groups(const dvi__part *part)
{
  for (int k = 0, group; k < part->target_count; k += group) {
    for (group = 1;
         group < 3 && k + group < part->target_count && is_beside(&part->target[k + group - 1]);)
      group++;
    for (int i = 0; i < group; i++) part->target[k + i].group = group - i;
  }
}

/* Take room for another part. NULL if there is no memory. */
static dvi__part *next_part(dvi__function *function, dvi__function_sum *sum)
{
  dvi__part *part = dvi__arena_grow(&function->arena, sum->part, (size_t)sum->part_count,
                                    sizeof *part);
  if (part == NULL) return NULL;
  sum->part = part;
  return &sum->part[sum->part_count++];
}

dvi_status dvi__sum_extend(dvi__function *function, dvi__function_sum *sum, int k, int root_count,
                           dvi__node *root, dvi__destination *target)
{
  const dvi__kernel *kernel = &function->kernel[k];
  if (root_count == 0 || kernel->elements == 0) return DVI_OK;
  dvi__part *part = next_part(function, sum);
  if (part == NULL) return DVI_NO_MEMORY;
  *part = (dvi__part){.kernel = kernel, .target_count = root_count, .target = target};
  maker m = {.function = function,
             .kernel = kernel,
             .derivatives = &function->derivatives[k],
             .part = part};
  for (int i = 0; i < root_count; i++)
    if (root[i] >= m.count) m.count = root[i] + 1;
  m.mark = dvi__heap_take((size_t)m.count + 1, sizeof *m.mark);
  m.input_node = dvi__heap_take((size_t)m.count + 1, sizeof *m.input_node);
  dvi_status status = m.mark != NULL && m.input_node != NULL ? DVI_OK : DVI_NO_MEMORY;
  int output_count = 0;
  if (status == DVI_OK) status = find_outputs(&m, root, &output_count);
  if (status == DVI_OK) {
    find_groups(part);
    status = maker_compile(&m, output_count, root);
  }
  dvi__heap_free(m.mark);
  dvi__heap_free(m.input_node);
  return status;
}
