/** The table of methods, and the keys that each method's specification takes.
 *
 *  A specification is `name[:key=value,...]`, for example
 *  "galerkin:degree=4,quadrature=lobatto,nodes=5". The functions below list the keys of a method.
 *  The key `solver` says how the equations of a step are solved. It takes auto, certified,
 *  fixed-point, simplified, newton or kinsol for galerkin, midpoint, trapezoidal and imex, and for
 *  lie-galerkin, euler-poincare and sphere-galerkin, which take the keys of galerkin. It takes
 *  newton or kinsol for sem. All other implicit methods choose their solver themselves. A
 *  composition hands the keys that are not its own to its base method, as in
 *  "composition:order=6,base=galerkin,degree=1". */
#ifndef DVI_METHOD_H
#define DVI_METHOD_H
#include <dvi/status.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Return the number of methods. */
int dvi_method_count(void);

/** Return the name of method i, 0 <= i < dvi_method_count(). NULL if i is out of range. */
const char *dvi_method_name(int i);

/** Return a description of the method in one line. NULL if i is out of range. */
const char *dvi_method_summary(int i);

/** Return the key of the method's source in docs/references.bib. NULL if i is out of range. */
const char *dvi_method_citation(int i);

/** Return the number of keys in the specification of method i. 0 if i is out of range. */
int dvi_method_key_count(int i);

/** Return the name of key k of method i, 0 <= k < dvi_method_key_count(i). NULL if i or k is out of
 *  range. */
const char *dvi_method_key_name(int i, int k);

/** Return the key's values, its default and its meaning, in one line. NULL if i or k is out of
 *  range. */
const char *dvi_method_key_help(int i, int k);

/** Find the path of the file that a specification names, such as the file of a tableau. A program
 *  may look at the file before an integrator opens it.
 *
 *  @param[out] length  length of the path. 0 if there is none
 *  @return the beginning of the path inside the specification. NULL if the specification names no
 *          file, or no method */
const char *dvi_method_file(const char *specification, size_t *length);

#ifdef __cplusplus
}
#endif
#endif
