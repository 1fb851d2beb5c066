/* A YAML document as a tree of scalars, sequences and mappings, read by libyaml's events. */
#ifndef DVI_SCENE_TEXT_TREE_H
#define DVI_SCENE_TEXT_TREE_H
#include "text/arena.h"
#include "text/complaint.h"

/* A sum is made of the expressions of several files. No document has one. */
typedef enum dvi__tree_kind { DVI__SCALAR, DVI__SEQUENCE, DVI__MAPPING, DVI__SUM } dvi__tree_kind;

typedef struct dvi__tree {
  dvi__tree_kind kind;
  dvi__span span;   /* of a scalar without quotes and block header, or of a collection */
  const char *text; /* the value of a scalar, ended by NUL */
  int plain;        /* 1 for a scalar with neither quotes nor a block header */
  int count;        /* children of a collection */
  struct dvi__tree *const *key;   /* [count] scalars, of a mapping, all different */
  struct dvi__tree *const *child; /* [count] */
} dvi__tree;

/* Read the one document. A list [x, y] may be a key. It is then a plain scalar, with its text as it
 * stands in the source. Anchors, aliases, tags, directives, more documents, other keys that are no
 * scalars, and duplicate keys are refused. So are texts that are not UTF-8, control characters,
 * quoted scalars in which an escape makes value and source differ, more than 64 levels, and more
 * than 1 MiB. */
bool dvi__tree_read(const dvi__source *source, dvi__arena *arena, dvi__complaint *complaint,
                    const dvi__tree **root);

/* Return the child of a key, or NULL. */
const dvi__tree *dvi__tree_find(const dvi__tree *mapping, const char *key);

#endif
