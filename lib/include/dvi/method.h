/** The table of methods, and what each method's specification may say.
 *
 *  A specification is `name[:key=value,...]`, for example
 *  "galerkin:degree=4,quadrature=lobatto,nodes=5". Which keys a method takes is asked below.
 *  `solver`, how the equations of a step are solved, is a key of galerkin, midpoint, trapezoidal
 *  and imex (auto, certified, fixed-point, simplified, newton, kinsol), of lie-galerkin,
 *  euler-poincare and sphere-galerkin, which take the keys of galerkin, and of sem (newton,
 *  kinsol); all other implicit methods choose themselves. A composition hands the keys that are not
 *  its own to its base method: "composition:order=6,base=galerkin,degree=1". */
#ifndef DVI_METHOD_H
#define DVI_METHOD_H
#include <dvi/status.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How many methods there are. */
int dvi_method_count(void);

/** Name of method i, 0 <= i < dvi_method_count(); NULL if out of range. */
const char *dvi_method_name(int i);

/** One line on what the method is; NULL if out of range. */
const char *dvi_method_summary(int i);

/** Key of the method's source in docs/references.bib; NULL if out of range. */
const char *dvi_method_citation(int i);

/** How many keys method i takes in its specification; 0 if out of range. */
int dvi_method_key_count(int i);

/** Name of key k of method i, 0 <= k < dvi_method_key_count(i); NULL if out of range. */
const char *dvi_method_key_name(int i, int k);

/** The key's values, its default and its meaning, in one line; NULL if out of range. */
const char *dvi_method_key_help(int i, int k);

/** The path of the file that a specification names, such as the one of a tableau: where it begins
 *  in the specification. A program may look at it before an integrator opens the file.
 *
 *  @param[out] length  of the path; 0 if there is none
 *  @return NULL if the specification names no file, or no method */
const char *dvi_method_file(const char *specification, size_t *length);

#ifdef __cplusplus
}
#endif
#endif
