#include "hdf5/head.h"

#include <string.h>

/* Longer texts are not shown in a reason. */
enum { SHOWN = 60 };

static const char layout_name[] = "layout", columns_name[] = "columns";

bool head_write(hid_t file, const hdf5_head *head)
{
  bool good = h5_put_texts(file, layout_name, 1, &head->layout);
  for (int i = 0; i < head->facts && good; i++) {
    const hdf5_fact *fact = &head->fact[i];
    good = fact->text != NULL ? h5_put_texts(file, fact->name, 1, &fact->text)
                              : h5_put_number(file, fact->name, fact->number);
  }
  return good;
}

bool head_write_columns(hid_t set, const hdf5_head *head)
{
  return h5_put_texts(set, columns_name, head->columns, head->column);
}

/* ---- reading ---- */

bool head_read_texts(hid_t place, const char *name, int count, char **text)
{
  const hid_t attribute = H5Aexists(place, name) > 0 ? H5Aopen(place, name, H5P_DEFAULT) : -1;
  if (attribute < 0) return false;
  const hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
  const bool good = H5Tis_variable_str(type) > 0 && H5Sget_simple_extent_npoints(space) == count &&
                    H5Aread(attribute, type, text) >= 0;
  (void)H5Sclose(space);
  (void)H5Tclose(type);
  (void)H5Aclose(attribute);
  return good;
}

int head_find_layout(hid_t file, const char *const *layout)
{
  char *found = NULL;
  int at = 0;
  if (!head_read_texts(file, layout_name, 1, &found) || found == NULL) {
    (void)h5_refuse("dvi has not written it");
    return -1;
  }
  while (layout[at] != NULL && strcmp(found, layout[at]) != 0) at++;
  if (layout[at] == NULL) {
    (void)h5_refuse("its layout is '%.*s', and this dvi knows '%s'", SHOWN, found, layout[0]);
    at = -1;
  }
  (void)H5free_memory(found);
  return at;
}

bool head_read_columns(hid_t set, int count, char **name)
{
  bool good = head_read_texts(set, columns_name, count, name);
  for (int i = 0; i < count && good; i++) good = name[i] != NULL;
  return good || h5_refuse("its columns have no names");
}

/* ---- comparison ---- */

static bool text_is_same(hid_t file, const char *name, const char *text)
{
  char *found = NULL;
  if (!head_read_texts(file, name, 1, &found) || found == NULL)
    return h5_refuse("it has no attribute '%s'", name);
  const bool same = strcmp(found, text) == 0;
  if (!same && strlen(found) < SHOWN && strlen(text) < SHOWN)
    (void)h5_refuse("its %s is '%s', not '%s'", name, found, text);
  else if (!same)
    (void)h5_refuse("its %s is another one", name);
  (void)H5free_memory(found);
  return same;
}

static bool number_is_same(hid_t file, const char *name, double number)
{
  double found = 0;
  const hid_t attribute = H5Aexists(file, name) > 0 ? H5Aopen(file, name, H5P_DEFAULT) : -1;
  const bool good = attribute >= 0 && H5Aread(attribute, H5T_NATIVE_DOUBLE, &found) >= 0;
  if (attribute >= 0) (void)H5Aclose(attribute);
  if (!good) return h5_refuse("it has no attribute '%s'", name);
  return found == number || h5_refuse("its %s is %.17g, not %.17g", name, found, number);
}

static bool columns_are_same(hid_t set, const hdf5_head *head)
{
  char **found = H5allocate_memory((size_t)head->columns * sizeof *found, true);
  bool same = found != NULL && head_read_texts(set, columns_name, head->columns, found);
  for (int i = 0; i < head->columns && found != NULL; i++) {
    same = same && found[i] != NULL && strcmp(found[i], head->column[i]) == 0;
    (void)H5free_memory(found[i]);
  }
  (void)H5free_memory(found);
  return same || h5_refuse("it has other columns");
}

bool head_is_same(hid_t file, hid_t set, const hdf5_head *head)
{
  bool same = text_is_same(file, layout_name, head->layout);
  for (int i = 0; i < head->facts && same; i++) {
    const hdf5_fact *fact = &head->fact[i];
    if (!fact->decides) continue;
    same = fact->text != NULL ? text_is_same(file, fact->name, fact->text)
                              : number_is_same(file, fact->name, fact->number);
  }
  return same && columns_are_same(set, head);
}
