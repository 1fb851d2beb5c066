/** Names of the columns of multipliers, lambda_NAME of holonomic constraints, and of nonholonomic
 *  ones behind them, and force_NAME of contacts that may be held. */
#ifndef REACTIONS_H
#define REACTIONS_H
#include "problem.h"

enum { REACTION_NAME_SIZE = 128 };

/** Return the number of rows of all these constraints, dvi_system_constraint_count. */
int reaction_count(const problem *scene);

/** Write the name of each row's column. Several rows of one name are numbered from 1. */
void reaction_names(const problem *scene, char (*name)[REACTION_NAME_SIZE]);

/** Write the name of the column of a contact's force. */
void force_name(const problem *scene, int contact, char name[REACTION_NAME_SIZE]);
#endif
