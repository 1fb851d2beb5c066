/* The table of methods, made from methods.def. */
#include <dvi/method.h>
#include <string.h>

#include "method/method.h"

#define METHOD(name) extern const dvi__method dvi__##name;
#include "method/methods.def"
#undef METHOD

static const dvi__method *const table[] = {
#define METHOD(name) &dvi__##name,
#include "method/methods.def"
#undef METHOD
};

int dvi_method_count(void)
{
  return (int)(sizeof table / sizeof *table);
}

/* This method is not in the table, because no specification makes it without the basis of a
 * program. */
extern const dvi__method dvi__shaped_galerkin;

static const dvi__method *method_table_entry(int i)
{
  return i >= 0 && i < dvi_method_count() ? table[i] : NULL;
}

const char *dvi_method_name(int i)
{
  return method_table_entry(i) != NULL ? table[i]->name : NULL;
}

const char *dvi_method_summary(int i)
{
  return method_table_entry(i) != NULL ? table[i]->summary : NULL;
}

const char *dvi_method_citation(int i)
{
  return method_table_entry(i) != NULL ? table[i]->cite : NULL;
}

int dvi__key_count(const dvi__method *method)
{
  int count = 0;
  while (method->keys != NULL && method->keys[count].name != NULL) count++;
  return count;
}

int dvi_method_key_count(int i)
{
  return method_table_entry(i) != NULL ? dvi__key_count(table[i]) + (table[i]->list != NULL) : 0;
}

/* Return the name of a key. The key that is a list comes last. */
const char *dvi_method_key_name(int i, int k)
{
  if (k < 0 || k >= dvi_method_key_count(i)) return NULL;
  return k < dvi__key_count(table[i]) ? table[i]->keys[k].name : table[i]->list;
}

const char *dvi_method_key_help(int i, int k)
{
  if (k < 0 || k >= dvi_method_key_count(i)) return NULL;
  return k < dvi__key_count(table[i]) ? table[i]->keys[k].help : table[i]->list_help;
}

static int is_called(const dvi__method *method, const char *name, size_t length)
{
  return strlen(method->name) == length && strncmp(method->name, name, length) == 0;
}

const dvi__method *dvi__find_method(const char *name, size_t length)
{
  for (int i = 0; i < dvi_method_count(); i++)
    if (is_called(table[i], name, length)) return table[i];
  return is_called(&dvi__shaped_galerkin, name, length) ? &dvi__shaped_galerkin : NULL;
}
