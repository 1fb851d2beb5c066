/* Specifications of kinds, name:key=value,... Each number has one spelling, plain digits. */
#include <dvi/number.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "core/status.h"
#include "field/space/kind.h"

enum { LONGEST_SHOWN = 80 };

const char *const dvi__no_yes[] = {"no", "yes", NULL};

void dvi__note_add(dvi__note *note, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  const size_t room = note->length < note->size ? note->size - note->length : 0;
  const int length = dvi_number_vprint(room > 0 ? note->text + note->length : NULL, room, format,
                                       arguments);
  va_end(arguments);
  if (length > 0) note->length += (size_t)length;
}

/* A part of a specification. */
typedef struct word {
  const char *text;
  int length;
} word;

static int same_word(word given, const char *name)
{
  return strlen(name) == (size_t)given.length &&
         strncmp(name, given.text, (size_t)given.length) == 0;
}

static word first_word(const char *text, const char *stops)
{
  return (word){text, (int)strcspn(text, stops)};
}

static int shown(word given)
{
  return given.length < LONGEST_SHOWN ? given.length : LONGEST_SHOWN;
}

static dvi_status refuse_kind(word name, int forms, const dvi__spec_form *const *form)
{
  char known[DVI__SENTENCE_SIZE] = "";
  dvi__note note = {known, sizeof known, 0};
  for (int i = 0; i < forms; i++) dvi__note_add(&note, "%s%s", i > 0 ? ", " : "", form[i]->name);
  return dvi__fail(DVI_BAD_OPTION, "space: there is no kind \"%.*s\" here; there are %s",
                   shown(name), name.text, known);
}

static dvi_status refuse_key(const dvi__spec_form *form, word name)
{
  char known[DVI__SENTENCE_SIZE] = "";
  dvi__note note = {known, sizeof known, 0};
  for (int k = 0; k < DVI__SPACE_KEYS && form->key[k].name != NULL; k++)
    dvi__note_add(&note, "%s%s", k > 0 ? ", " : "", form->key[k].name);
  return dvi__fail(DVI_BAD_OPTION, "space: %s has no option \"%.*s\"; it has %s", form->name,
                   shown(name), name.text, known);
}

static dvi_status read_word(const char *kind, const dvi__space_key *key, word given, int *value)
{
  char known[DVI__SENTENCE_SIZE] = "";
  dvi__note note = {known, sizeof known, 0};
  for (int i = 0; key->word[i] != NULL; i++) {
    *value = i;
    if (same_word(given, key->word[i])) return DVI_OK;
    dvi__note_add(&note, "%s%s", i > 0 ? " and " : "", key->word[i]);
  }
  return dvi__fail(DVI_BAD_OPTION, "space: %s: %s=%.*s; %s are possible", kind, key->name,
                   shown(given), given.text, known);
}

static dvi_status read_number(const char *kind, const dvi__space_key *key, word given, int *value)
{
  const int digits = (int)strspn(given.text, "0123456789");
  const int is_plain = digits == given.length && digits > 0 &&
                       (given.text[0] != '0' || digits == 1);
  const long number = is_plain ? strtol(given.text, NULL, 10) : -1; /* LONG_MAX if out of range */
  if (number < key->least || number > key->most)
    return dvi__fail(DVI_BAD_OPTION,
                     "space: %s: %s=%.*s; whole numbers from %d to %d in plain digits are possible",
                     kind, key->name, shown(given), given.text, key->least, key->most);
  *value = (int)number;
  return DVI_OK;
}

static dvi_status assign(const dvi__spec_form *form, word name, word given, unsigned *seen,
                         int *value)
{
  for (int k = 0; k < DVI__SPACE_KEYS && form->key[k].name != NULL; k++) {
    const dvi__space_key *key = &form->key[k];
    if (!same_word(name, key->name)) continue;
    if (*seen & 1U << k)
      return dvi__fail(DVI_BAD_OPTION, "space: %s: %s is given twice", form->name, key->name);
    *seen |= 1U << k;
    return (key->word != NULL ? read_word : read_number)(form->name, key, given, &value[k]);
  }
  return refuse_key(form, name);
}

static dvi_status read_options(const dvi__spec_form *form, const char *text, int *value)
{
  unsigned seen = 0;
  for (;; text++) {
    const word name = first_word(text, "=,");
    text += name.length;
    const int has_value = *text == '=';
    const word given = first_word(text + has_value, ",");
    if (!has_value)
      return dvi__fail(DVI_BAD_OPTION, "space: %s: \"%.*s\" is no option; write name=value",
                       form->name, shown(name), name.text);
    DVI_TRY(assign(form, name, given, &seen, value));
    text = given.text + given.length;
    if (*text == '\0') return DVI_OK;
  }
}

dvi_status dvi__spec_read(const char *spec, int forms, const dvi__spec_form *const *form,
                          int *number, int value[DVI__SPACE_KEYS])
{
  const word name = first_word(spec, ":");
  for (int i = 0; i < forms; i++) {
    if (!same_word(name, form[i]->name)) continue;
    *number = i;
    for (int k = 0; k < DVI__SPACE_KEYS; k++) value[k] = form[i]->key[k].fallback;
    return spec[name.length] == '\0' ? DVI_OK
                                     : read_options(form[i], spec + name.length + 1, value);
  }
  return refuse_kind(name, forms, form);
}
