/* A YAML document as a tree of scalars, sequences and mappings, read by libyaml's events. */
#ifndef DVI_SCENE_TREE_H
#define DVI_SCENE_TREE_H
#include "text/arena.h"
#include "text/complaint.h"

typedef enum dvi__tree_kind { DVI__SCALAR, DVI__SEQUENCE, DVI__MAPPING } dvi__tree_kind;

typedef struct dvi__tree {
  dvi__tree_kind kind;
  dvi__span span;   /* of a scalar: its characters in the source, without quotes and block headers;
                       else the whole collection */
  const char *text; /* of a scalar: its value, ended by NUL */
  int plain;        /* of a scalar: 1 if it has neither quotes nor a block header */
  int count;        /* of a collection */
  struct dvi__tree *const *key;   /* [count] scalars, of a mapping, all different */
  struct dvi__tree *const *child; /* [count] */
} dvi__tree;

/* Read the one document. A list [x, y] may be a key: it is a plain scalar then, with its text as it
 * stands in the source. Refused: anchors, aliases, tags, directives, more documents, other keys
 * that are no scalars, duplicate keys, what is not UTF-8, control characters, quoted scalars in
 * which an escape makes value and source differ, more than 64 levels or 1 MiB. */
bool dvi__tree_read(const dvi__source *source, dvi__arena *arena, dvi__complaint *complaint,
                    const dvi__tree **root);

/* The child of a key, or NULL. */
const dvi__tree *dvi__tree_find(const dvi__tree *mapping, const char *key);

#endif
