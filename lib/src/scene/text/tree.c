/* The tree is built from libyaml's events. Anything in YAML beyond scalars, sequences and mappings
 * is refused, since it would make a scene mean what does not stand in it.
 *
 * libyaml counts characters, and spans count bytes. So a place is kept along the text. The text is
 * checked before libyaml sees it, so that libyaml complains of YAML and not of letters. */
#include "scene/text/tree.h"
#include "text/utf8.h"

#include <stdlib.h>
#include <string.h>
#include <yaml.h>

enum { SIZE_MAX_BYTES = 1 << 20, LEVELS_MAX = 64 };

/* A collection that is open. */
typedef struct level {
  dvi__tree *tree, **key, **child;
  size_t key_count, child_count;
  bool is_key; /* the collection itself is a key */
} level;

typedef struct reader {
  const dvi__source *source;
  dvi__arena *arena;
  dvi__complaint *complaint;
  size_t index, offset; /* a place in characters, and in bytes */
  size_t last;          /* the end of the last item, with its quotes or brackets */
  dvi__tree *root;
  size_t depth;
  level open[LEVELS_MAX];
} reader;

static bool tree_no_memory(const reader *r)
{
  return dvi__complain_of_memory(r->complaint);
}

static bool tree_complain(const reader *r, dvi__span where, const char *sentence)
{
  return dvi__complain(r->complaint, DVI_BAD_FILE, where, "%s", sentence);
}

static bool continues_character(const reader *r, size_t offset)
{
  return offset < r->source->size && ((unsigned char)r->source->text[offset] & 0xC0) == 0x80;
}

/* Return the place of a mark. Marks come almost in their order, so the way from the last one is
 * short. */
static size_t place_of_mark(reader *r, const yaml_mark_t *mark)
{
  while (r->index < mark->index && r->offset < r->source->size) {
    do r->offset++;
    while (continues_character(r, r->offset));
    r->index++;
  }
  while (r->index > mark->index && r->offset > 0) {
    do r->offset--;
    while (continues_character(r, r->offset));
    r->index--;
  }
  return r->offset;
}

static dvi__span span_of(reader *r, const yaml_event_t *event)
{
  const size_t first = place_of_mark(r, &event->start_mark);
  const size_t end = place_of_mark(r, &event->end_mark);
  return (dvi__span){first, end - first};
}

/* Return the text in a block, after the line of its header. */
static dvi__span inside_block(const dvi__source *source, dvi__span span)
{
  size_t first = span.first;
  const size_t end = span.first + span.size;
  while (first < end && source->text[first] != '\n' && source->text[first] != '\r') first++;
  while (first < end && dvi__is_blank(source->text[first])) first++;
  return (dvi__span){first, end - first};
}

/* Find the value of a scalar in the source. Its characters there are its value but for breaks of
 * lines and indentation. */
static bool inside_scalar(const reader *r, yaml_scalar_style_t style, dvi__span span,
                          dvi__span *inside)
{
  *inside = span;
  if (style == YAML_LITERAL_SCALAR_STYLE || style == YAML_FOLDED_SCALAR_STYLE)
    *inside = inside_block(r->source, span);
  if (style != YAML_SINGLE_QUOTED_SCALAR_STYLE && style != YAML_DOUBLE_QUOTED_SCALAR_STYLE)
    return true;
  *inside = (dvi__span){span.first + 1, span.size - 2};
  const char escape = style == YAML_DOUBLE_QUOTED_SCALAR_STYLE ? '\\' : '\'';
  const char *found = memchr(r->source->text + inside->first, escape, inside->size);
  if (found == NULL) return true;
  const dvi__span where = {(size_t)(found - r->source->text), escape == '\\' ? 1 : 2};
  return tree_complain(
      r, where,
      escape == '\\'
          ? "a backslash in double quotes makes text that does not stand here; write it without"
          : "'' in single quotes stands for one '; write double quotes around the text");
}

/* Put a new node into its parent. At a place for a key it becomes the key. */
static bool attach_node(reader *r, dvi__tree *node, bool *is_key)
{
  *is_key = false;
  if (r->depth == 0) {
    r->root = node;
    return true;
  }
  level *parent = &r->open[r->depth - 1];
  *is_key = parent->tree->kind == DVI__MAPPING && parent->key_count == parent->child_count;
  dvi__tree ***row = *is_key ? &parent->key : &parent->child;
  size_t *count = *is_key ? &parent->key_count : &parent->child_count;
  dvi__tree **grown = dvi__arena_grow(r->arena, *row, *count, sizeof(dvi__tree *));
  if (grown == NULL) return tree_no_memory(r);
  grown[(*count)++] = node;
  *row = grown;
  return true;
}

/* Refuse an anchor or a tag, which stands at the head of its node. */
static bool refuse_properties(const reader *r, const unsigned char *anchor, dvi__span span)
{
  const dvi__span where = {span.first, 1};
  if (anchor != NULL)
    return tree_complain(r, where,
                         "anchors (&) are not for scenes; write the value where it is needed");
  if (span.size > 0 && r->source->text[span.first] == '!')
    return tree_complain(
        r, where, "tags (!) are not for scenes; leave it out, or put quotes around the text");
  return true;
}

static bool add_scalar(reader *r, const yaml_event_t *event)
{
  dvi__span span = span_of(r, event);
  while (span.size > 0 && dvi__is_blank(r->source->text[span.first + span.size - 1]))
    span.size--; /* the end of a block */
  if (!refuse_properties(r, event->data.scalar.anchor, span)) return false;
  dvi__span inside = span;
  if (!inside_scalar(r, event->data.scalar.style, span, &inside)) return false;
  dvi__tree *node = dvi__arena_take(r->arena, 1, sizeof *node);
  const char *text = dvi__arena_text(r->arena, (const char *)event->data.scalar.value,
                                     event->data.scalar.length);
  if (node == NULL || text == NULL) return tree_no_memory(r);
  const int plain = event->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
  *node = (dvi__tree){.kind = DVI__SCALAR, .span = inside, .text = text, .plain = plain};
  r->last = span.first + span.size;
  bool is_key = false;
  return attach_node(r, node, &is_key);
}

static bool open_collection(reader *r, dvi__tree_kind kind, const yaml_event_t *event, bool list)
{
  const dvi__span span = span_of(r, event);
  const dvi__span where = {span.first, 1};
  const unsigned char *anchor = kind == DVI__MAPPING ? event->data.mapping_start.anchor
                                                     : event->data.sequence_start.anchor;
  if (!refuse_properties(r, anchor, span)) return false;
  if (r->depth == LEVELS_MAX)
    return dvi__complain(r->complaint, DVI_BAD_SIZE, where, "more than %d levels of nesting",
                         LEVELS_MAX);
  dvi__tree *node = dvi__arena_take(r->arena, 1, sizeof *node);
  if (node == NULL) return tree_no_memory(r);
  *node = (dvi__tree){.kind = kind, .span = span};
  bool is_key = false;
  if (!attach_node(r, node, &is_key)) return false;
  if (is_key && !list)
    return tree_complain(r, where,
                         "a key is a name, or a list of names, and no mapping or sequence");
  r->open[r->depth++] = (level){.tree = node, .is_key = is_key};
  return true;
}

static int compare_texts(const void *a, const void *b)
{
  const dvi__tree *left = *(dvi__tree *const *)a;
  const dvi__tree *right = *(dvi__tree *const *)b;
  const int order = strcmp(left->text, right->text);
  return order != 0 ? order : left->span.first < right->span.first ? -1 : 1;
}

static bool keys_differ(const reader *r, dvi__tree *const *key, size_t count)
{
  const dvi__tree **sorted = dvi__arena_take(r->arena, count, sizeof *sorted);
  if (sorted == NULL) return tree_no_memory(r);
  for (size_t k = 0; k < count; k++) sorted[k] = key[k];
  qsort(sorted, count, sizeof *sorted, compare_texts);
  for (size_t k = 1; k < count; k++) {
    if (strcmp(sorted[k - 1]->text, sorted[k]->text) != 0) continue;
    int line = 0;
    int column = 0;
    dvi__source_place(r->source, sorted[k - 1]->span.first, &line, &column);
    return dvi__complain(r->complaint, DVI_BAD_FILE, sorted[k]->span,
                         "the key '%s' stands in line %d already", sorted[k]->text, line);
  }
  return true;
}

/* Refuse keys that are assignments. To YAML {g=9.81} and {g:9.81} are keys without values. */
static bool none_assigned(const reader *r, const dvi__tree *mapping)
{
  for (int k = 0; k < mapping->count; k++) {
    const dvi__tree *key = mapping->key[k], *value = mapping->child[k];
    const size_t length = strcspn(key->text, "=:");
    size_t name = length;
    if (key->text[length] == '\0' || !key->plain || value->kind != DVI__SCALAR || !value->plain ||
        value->text[0] != '\0')
      continue;
    while (name > 0 && dvi__is_blank(key->text[name - 1])) name--;
    const char *right = key->text + length + 1;
    while (dvi__is_blank(*right)) right++;
    return dvi__complain(r->complaint, DVI_BAD_FILE, key->span,
                         "a key is followed by a colon and a blank; write %.*s: %s", (int)name,
                         key->text, right);
  }
  return true;
}

/* Turn a list that is a key into a scalar with its own source as text. */
static bool turn_to_scalar(const reader *r, dvi__tree *node)
{
  const char *text = dvi__arena_text(r->arena, r->source->text + node->span.first, node->span.size);
  if (text == NULL) return tree_no_memory(r);
  *node = (dvi__tree){.kind = DVI__SCALAR, .span = node->span, .text = text, .plain = 1};
  return true;
}

static bool close_collection(reader *r, const yaml_event_t *event)
{
  const level *closed = &r->open[--r->depth];
  dvi__tree *node = closed->tree;
  const dvi__span bracket = span_of(r, event);
  if (bracket.size > 0)
    r->last = bracket.first + bracket.size; /* otherwise it ends with its last item */
  node->span.size = r->last - node->span.first;
  node->count = (int)closed->child_count;
  node->key = closed->key;
  node->child = closed->child;
  if (closed->is_key) return turn_to_scalar(r, node);
  if (node->kind != DVI__MAPPING) return true;
  return none_assigned(r, node) &&
         (node->count < 2 || keys_differ(r, node->key, closed->key_count));
}

static bool start_document(reader *r, const yaml_event_t *event)
{
  const dvi__span where = {place_of_mark(r, &event->start_mark), 1};
  if (event->data.document_start.version_directive != NULL ||
      event->data.document_start.tag_directives.start !=
          event->data.document_start.tag_directives.end)
    return tree_complain(r, where, "directives (%) are not for scenes; leave the line out");
  if (r->root != NULL)
    return tree_complain(r, where, "a second document begins here; a scene is one");
  return true;
}

static bool take_event(reader *r, const yaml_event_t *event)
{
  switch (event->type) {
  case YAML_DOCUMENT_START_EVENT: return start_document(r, event);
  case YAML_ALIAS_EVENT:
    return tree_complain(
        r, span_of(r, event),
        "aliases (*) are not for scenes; write the value, or put quotes around the text");
  case YAML_SCALAR_EVENT: return add_scalar(r, event);
  case YAML_SEQUENCE_START_EVENT:
    return open_collection(r, DVI__SEQUENCE, event,
                           event->data.sequence_start.style == YAML_FLOW_SEQUENCE_STYLE);
  case YAML_MAPPING_START_EVENT: return open_collection(r, DVI__MAPPING, event, false);
  case YAML_SEQUENCE_END_EVENT:
  case YAML_MAPPING_END_EVENT:
    return r->depth == 0 ||
           close_collection(r, event); /* never 0, but that is not seen from here */
  default: return true;
  }
}

/* Return the end of the last word. Anything missing at a file's end is shown in its last line. */
static size_t end_of_text(const dvi__source *source)
{
  size_t end = source->size;
  while (end > 0 && dvi__is_blank(source->text[end - 1])) end--;
  return end;
}

/* Complain with libyaml's sentence, and with remedies for the usual mistakes. */
static bool refuse_syntax(reader *r, const yaml_parser_t *parser)
{
  static const char *const remedy[][2] = {
      {"mapping values are not allowed", "; a text with a colon and a blank needs quotes, and keys "
                                         "of one mapping the same indentation"},
      {"expected ',' or ']'",
       "; an element with brackets or commas needs quotes, as \"[x[1], y[1]]\" does as a whole"},
      {"expected ',' or '}'", "; an element with brackets or commas needs quotes"},
      {"cannot start any token",
       "; indent by blanks, not by tabs, and put quotes around texts that begin with @, ` or %"},
      {"did not find expected key", "; is the line indented as those above?"},
      {"could not find expected ':'", "; a key is followed by a colon and a blank"},
  };
  if (parser->error == YAML_MEMORY_ERROR) return tree_no_memory(r);
  const char *problem = parser->problem != NULL ? parser->problem : "something is wrong";
  const char *context = parser->context != NULL ? parser->context : "";
  const char *help = "";
  for (size_t k = 0; k < sizeof remedy / sizeof *remedy && help[0] == '\0'; k++)
    if (strstr(problem, remedy[k][0]) != NULL) help = remedy[k][1];
  dvi__span where = {place_of_mark(r, &parser->problem_mark), 1};
  const bool begins_before = where.first == r->source->size ||
                             strstr(problem, "expected ':'") != NULL;
  if (begins_before && parser->context != NULL)
    where.first = place_of_mark(r, &parser->context_mark); /* the beginning says more */
  if (where.first == r->source->size) where.first = end_of_text(r->source);
  return dvi__complain(r->complaint, DVI_BAD_FILE, where, "this is no YAML: %s%s%s%s", problem,
                       context[0] != '\0' ? " " : "", context, help);
}

static bool read_events(reader *r, yaml_parser_t *parser)
{
  bool fine = true;
  for (bool end = false; fine && !end;) {
    yaml_event_t event;
    if (!yaml_parser_parse(parser, &event)) return refuse_syntax(r, parser);
    end = event.type == YAML_STREAM_END_EVENT;
    fine = take_event(r, &event);
    yaml_event_delete(&event);
  }
  return fine;
}

/* Return true for binary files. Texts have no NULs. A single NUL is a mistake and is reported with
 * its place. */
static bool is_binary(const dvi__source *source)
{
  const char *end = source->text + source->size, *first = memchr(source->text, '\0', source->size);
  return first != NULL && memchr(first + 1, '\0', (size_t)(end - first - 1)) != NULL;
}

/* Refuse other encodings, and characters that cannot be seen. */
static bool check_characters(const reader *r)
{
  const dvi__source *source = r->source;
  if (source->size >= 2 &&
      (memcmp(source->text, "\xFF\xFE", 2) == 0 || memcmp(source->text, "\xFE\xFF", 2) == 0))
    return tree_complain(r, DVI__NOWHERE, "the file is UTF-16; save it as UTF-8");
  if (is_binary(source))
    return dvi__complain_of_file(r->complaint, DVI__NOWHERE, "this is a binary file");
  if (source->size >= 3 && memcmp(source->text, "\xEF\xBB\xBF", 3) == 0)
    return tree_complain(r, DVI__NOWHERE,
                         "the file begins with a byte order mark; save it as UTF-8 without one");
  unsigned code = 0;
  for (size_t k = 0, width = 0; k < source->size; k += width) {
    width = dvi__utf8(source->text + k, source->size - k, &code);
    const dvi__span where = {k, 1};
    if (width == 0) return tree_complain(r, where, "this byte is no UTF-8; save the file as UTF-8");
    if (!dvi__utf8_printable(code))
      return dvi__complain(r->complaint, DVI_BAD_FILE, where,
                           "the character U+%04X cannot stand in a scene", code);
  }
  return true;
}

bool dvi__tree_read(const dvi__source *source, dvi__arena *arena, dvi__complaint *complaint,
                    const dvi__tree **root)
{
  *root = NULL;
  reader r = {.source = source, .arena = arena, .complaint = complaint};
  if (source->size > SIZE_MAX_BYTES)
    return dvi__complain(complaint, DVI_BAD_SIZE, DVI__NOWHERE, "the file has more than 1 MiB");
  if (!check_characters(&r)) return false;
  yaml_parser_t parser;
  if (!yaml_parser_initialize(&parser)) return tree_no_memory(&r);
  yaml_parser_set_encoding(&parser, YAML_UTF8_ENCODING);
  yaml_parser_set_input_string(&parser, (const unsigned char *)source->text, source->size);
  const bool fine = read_events(&r, &parser);
  yaml_parser_delete(&parser);
  if (!fine) return false;
  if (r.root == NULL) return dvi__complain_of_file(complaint, DVI__NOWHERE, "the file is empty");
  *root = r.root;
  return true;
}

const dvi__tree *dvi__tree_find(const dvi__tree *mapping, const char *key)
{
  if (mapping->kind != DVI__MAPPING) return NULL;
  for (int k = 0; k < mapping->count; k++)
    if (strcmp(mapping->key[k]->text, key) == 0) return mapping->child[k];
  return NULL;
}
