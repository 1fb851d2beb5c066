/* Specifications have the form name[:key=value,...]. */
#include <dvi/method.h>
#include <dvi/number.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "method/method.h"

void dvi__text_add(dvi__text *text, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  const size_t room = text->length < text->size ? text->size - text->length : 0;
  const int length = dvi_number_vprint(room > 0 ? text->text + text->length : NULL, room, format,
                                       arguments);
  va_end(arguments);
  if (length > 0) text->length += (size_t)length;
}

char *dvi__written(const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  const int length = dvi_number_vprint(NULL, 0, format, arguments);
  va_end(arguments);
  char *text = DVI_NEW(char, (size_t)length + 1);
  if (text == NULL) return NULL;
  va_start(arguments, format);
  (void)dvi_number_vprint(text, (size_t)length + 1, format, arguments);
  va_end(arguments);
  return text;
}

void dvi__settings_clear(dvi__settings *settings)
{
  dvi__release(settings->list_text);
  dvi__release(settings->file);
  dvi__release(settings->rest);
  settings->list_text = settings->file = settings->rest = NULL;
}

static dvi_status settings_no_memory(const dvi__method *method)
{
  return dvi__fail(DVI_NO_MEMORY, "%s: no memory for its specification", method->name);
}

/* A token of a specification, which has no terminating 0. */
typedef struct token {
  const char *text;
  int length;
} token;

static int settings_same_text(token given, const char *word)
{
  return (int)strlen(word) == given.length && strncmp(word, given.text, (size_t)given.length) == 0;
}

static const char *end_of(const char *text, const char *stops)
{
  return text + strcspn(text, stops);
}

static dvi_status unknown_key(const dvi__method *method, token name)
{
  char known[DVI__SENTENCE_SIZE] = "";
  dvi__text text = {known, sizeof known, 0};
  for (int k = 0; k < dvi__key_count(method); k++)
    dvi__text_add(&text, "%s%s", k > 0 ? ", " : "", method->keys[k].name);
  if (method->list != NULL) dvi__text_add(&text, ", %s", method->list);
  return dvi__fail(DVI_BAD_OPTION, "%s: unknown key '%.*s'; %s%s", method->name, name.length,
                   name.text, text.length > 0 ? "it takes " : "it takes none", known);
}

/* Each number has one spelling. Signs, blanks and leading zeros are refused, although strtol takes
 * them. Returns the length of the digits, or 0 for another spelling. */
static int plain_digits(const char *text)
{
  const int digits = (int)strspn(text, "0123456789");
  return text[0] != '0' || digits == 1 ? digits : 0;
}

enum { LONGEST_DECIMAL = 15 }; /* a double keeps this many digits */

/* Accept decimals, too, of which the last is not 0. Returns the length as plain_digits does. */
static int plain_decimal(const char *text)
{
  const int whole = plain_digits(text);
  if (whole == 0 || text[whole] != '.') return whole;
  const int decimals = (int)strspn(text + whole + 1, "0123456789");
  return decimals > 0 && text[whole + decimals] != '0' ? whole + 1 + decimals : 0;
}

static dvi_status parse_number(const dvi__method *method, const dvi__key *key, token value,
                               int *number)
{
  if (plain_digits(value.text) != value.length || value.length == 0)
    return dvi__fail(DVI_BAD_OPTION, "%s: %s=%.*s is not a whole number in plain digits",
                     method->name, key->name, value.length, value.text);
  const long parsed = strtol(value.text, NULL, 10); /* LONG_MAX if out of range */
  if (parsed < key->least || parsed > key->most)
    return dvi__fail(DVI_BAD_OPTION, "%s: %s=%.*s; %d to %d are possible", method->name, key->name,
                     value.length, value.text, key->least, key->most);
  *number = (int)parsed;
  return DVI_OK;
}

static dvi_status parse_list(const dvi__method *method, token value, dvi__settings *settings)
{
  if (settings->listed > 0)
    return dvi__fail(DVI_BAD_OPTION, "%s: %s is given twice", method->name, method->list);
  const char *end = value.text + value.length;
  for (const char *at = value.text;; at++) {
    const int length = plain_decimal(at);
    if (length == 0 || length > LONGEST_DECIMAL || (at + length != end && at[length] != ':'))
      return dvi__fail(
          DVI_BAD_OPTION,
          "%s: %s=%.*s is not a list of numbers in plain digits, such as 2 or 1:0.5; positive ones "
          "of at most %d characters are possible, without sign, exponent, or zeros at the ends",
          method->name, method->list, value.length, value.text, LONGEST_DECIMAL);
    if (settings->listed == DVI__LIST_MOST)
      return dvi__fail(DVI_BAD_OPTION, "%s: %s has more than %d numbers; 1 to %d are possible",
                       method->name, method->list, DVI__LIST_MOST, DVI__LIST_MOST);
    (void)dvi_number_read(at, &settings->list[settings->listed++]);
    at += length;
    if (at == end) break;
  }
  settings->list_text = dvi__written("%.*s", value.length, value.text);
  return settings->list_text != NULL ? DVI_OK : settings_no_memory(method);
}

static dvi_status parse_choice(const dvi__method *method, const dvi__key *key, token value,
                               int *choice)
{
  char known[DVI__SENTENCE_SIZE] = "";
  dvi__text text = {known, sizeof known, 0};
  for (int c = 0; key->choice(c) != NULL; c++) {
    if (settings_same_text(value, key->choice(c))) {
      *choice = c;
      return DVI_OK;
    }
    dvi__text_add(&text, "%s%s", c > 0 ? ", " : "", key->choice(c));
  }
  if (key->most > 0) dvi__text_add(&text, " and %d to %d", key->least, key->most);
  return dvi__fail(DVI_BAD_OPTION, "%s: %s=%.*s; possible are %s", method->name, key->name,
                   value.length, value.text, known);
}

/* Return 1 if the value is a number. A key may take names beside numbers. */
static int is_number(const dvi__key *key, token value)
{
  return key->choice == NULL ||
         (key->most > 0 && value.length > 0 && value.text[0] >= '0' && value.text[0] <= '9');
}

static dvi_status parse_real(const dvi__method *method, const dvi__key *key, token value,
                             double *number)
{
  *number = 0;
  if (settings_same_text(value, "auto")) return DVI_OK;
  const char *end = dvi_number_read(value.text, number);
  if (value.length > 0 && end == value.text + value.length && isfinite(*number) && *number > 0)
    return DVI_OK;
  return dvi__fail(DVI_BAD_OPTION, "%s: %s=%.*s; a positive number is possible, or auto",
                   method->name, key->name, value.length, value.text);
}

static dvi_status keep_file(const dvi__method *method, const dvi__key *key, token value,
                            dvi__settings *settings)
{
  if (value.length == 0)
    return dvi__fail(DVI_BAD_OPTION, "%s: %s= is empty; give it a text, or leave it out",
                     method->name, key->name);
  settings->file = dvi__written("%.*s", value.length, value.text);
  return settings->file != NULL ? DVI_OK : settings_no_memory(method);
}

static dvi_status keep_for_others(const dvi__method *method, token name, token value,
                                  dvi__settings *settings)
{
  char *before = settings->rest;
  settings->rest = dvi__written("%s%s%.*s=%.*s", before != NULL ? before : "",
                                before != NULL ? "," : "", name.length, name.text, value.length,
                                value.text);
  dvi__release(before);
  return settings->rest != NULL ? DVI_OK : settings_no_memory(method);
}

static dvi_status settings_assign(const dvi__method *method, token name, token value,
                                  dvi__settings *settings, unsigned *given)
{
  for (int k = 0; k < dvi__key_count(method); k++) {
    const dvi__key *key = &method->keys[k];
    if (!settings_same_text(name, key->name)) continue;
    if (*given & 1U << k)
      return dvi__fail(DVI_BAD_OPTION, "%s: %s is given twice", method->name, key->name);
    *given |= 1U << k;
    if (key->least == DVI__POSITIVE) return parse_real(method, key, value, &settings->number[k]);
    if (key->least == DVI__FILE) return keep_file(method, key, value, settings);
    return is_number(key, value) ? parse_number(method, key, value, &settings->value[k])
                                 : parse_choice(method, key, value, &settings->value[k]);
  }
  if (method->list != NULL && settings_same_text(name, method->list))
    return parse_list(method, value, settings);
  return method->takes_rest ? keep_for_others(method, name, value, settings)
                            : unknown_key(method, name);
}

/* A long unknown name shall not push the known names out of the sentence. */
enum { LONGEST_SHOWN = 80 };

static dvi_status unknown_method(token name)
{
  char known[DVI__SENTENCE_SIZE] = "";
  dvi__text text = {known, sizeof known, 0};
  for (int i = 0; i < dvi_method_count(); i++)
    dvi__text_add(&text, "%s%s", i > 0 ? ", " : "", dvi_method_name(i));
  const int shown = name.length < LONGEST_SHOWN ? name.length : LONGEST_SHOWN;
  return dvi__fail(DVI_BAD_OPTION, "unknown method '%.*s'; there are %s", shown, name.text, known);
}

/* Read the key and the value behind a colon or comma. The value has no text if there is none.
 * Returns the end of the pair. */
static const char *take_pair(const char *at, token *name, token *value)
{
  const char *start = at + 1, *equals = end_of(start, "=,"), *end = end_of(equals, ",");
  *name = (token){start, (int)(equals - start)};
  *value = *equals == '=' && equals > start ? (token){equals + 1, (int)(end - equals - 1)}
                                            : (token){0};
  return end;
}

static int settings_names_file(const dvi__method *method, token name)
{
  for (int k = 0; k < dvi__key_count(method); k++)
    if (settings_same_text(name, method->keys[k].name)) return method->keys[k].least == DVI__FILE;
  return 0;
}

/* Return 1 if the key may name a file. Keys that a method hands on may be those of any other
 * method. */
static int may_name_file(const dvi__method *method, token name)
{
  int found = settings_names_file(method, name);
  for (int i = 0; method->takes_rest && i < dvi_method_count(); i++)
    found |= settings_names_file(dvi__find_method(dvi_method_name(i), strlen(dvi_method_name(i))),
                                 name);
  return found;
}

const char *dvi_method_file(const char *specification, size_t *length)
{
  const char *at = specification != NULL ? end_of(specification, ":") : "";
  const dvi__method *method = *at != 0
                                  ? dvi__find_method(specification, (size_t)(at - specification))
                                  : NULL;
  *length = 0;
  while (method != NULL && *at != 0) {
    token name, value;
    at = take_pair(at, &name, &value);
    if (value.length == 0 || !may_name_file(method, name)) continue;
    *length = (size_t)value.length;
    return value.text;
  }
  return NULL;
}

/* Limit the length, because all functions below count characters by ints. */
static dvi_status check_length(const char *specification)
{
  const size_t length = strlen(specification);
  if (length <= DVI__SPECIFICATION_MOST) return DVI_OK;
  return dvi__fail(DVI_BAD_OPTION,
                   "the method '%.40s...' has %zu characters; at most %d are possible",
                   specification, length, DVI__SPECIFICATION_MOST);
}

dvi_status dvi__parse(const char *specification, const dvi__method **method,
                      dvi__settings *settings)
{
  unsigned given = 0;
  *settings = (dvi__settings){0};
  DVI_TRY(check_length(specification));
  const char *at = end_of(specification, ":");
  const token method_name = {specification, (int)(at - specification)};
  *method = dvi__find_method(specification, (size_t)(at - specification));
  if (*method == NULL) return unknown_method(method_name);
  for (int k = 0; k < dvi__key_count(*method); k++)
    settings->value[k] = (*method)->keys[k].default_value;
  while (*at != 0) {
    token name, value;
    const char *end = take_pair(at, &name, &value);
    if (value.text == NULL)
      return dvi__fail(DVI_BAD_OPTION, "%s: '%.*s' is not key=value", (*method)->name,
                       (int)(end - name.text), name.text);
    DVI_TRY(settings_assign(*method, name, value, settings, &given));
    at = end;
  }
  return DVI_OK;
}

static void spell_real(double number, dvi__text *text)
{
  char spelled[DVI_NUMBER_SIZE] = "auto";
  if (number != 0) dvi_number_write(number, spelled);
  dvi__text_add(text, "%s", spelled);
}

/* Write the value of key k as in a specification. */
static void spell_value(const dvi__method *method, const dvi__settings *settings, int k,
                        dvi__text *text)
{
  const dvi__key *key = &method->keys[k];
  if (key->least == DVI__POSITIVE)
    spell_real(settings->number[k], text);
  else if (key->least == DVI__FILE)
    dvi__text_add(text, "%s", settings->file);
  else if (key->choice != NULL && key->choice(settings->value[k]) != NULL)
    dvi__text_add(text, "%s", key->choice(settings->value[k]));
  else
    dvi__text_add(text, "%d", settings->value[k]);
}

static void settings_spell(const dvi__method *method, const dvi__settings *settings,
                           dvi__text *text)
{
  dvi__text_add(text, "%s", method->name);
  for (int k = 0; k < dvi__key_count(method); k++) {
    if (method->keys[k].least == DVI__FILE && settings->file == NULL) continue;
    dvi__text_add(text, "%c%s=", k == 0 ? ':' : ',', method->keys[k].name);
    spell_value(method, settings, k, text);
  }
  if (settings->list_text != NULL) dvi__text_add(text, ",%s=%s", method->list, settings->list_text);
  if (settings->rest != NULL)
    dvi__text_add(text, "%c%s", dvi__key_count(method) == 0 ? ':' : ',', settings->rest);
}

/* The first pass finds the length only. */
char *dvi__spell_out(const dvi__method *method, const dvi__settings *settings)
{
  dvi__text text = {NULL, 0, 0};
  settings_spell(method, settings, &text);
  text = (dvi__text){DVI_NEW(char, text.length + 1), text.length + 1, 0};
  if (text.text != NULL) settings_spell(method, settings, &text);
  return text.text;
}

char *dvi__spell_steps(const dvi__method *method, const dvi__settings *settings)
{
  dvi__settings steps = *settings;
  steps.file = NULL;
  for (int k = 0; k < dvi__key_count(method); k++)
    if (method->keys[k].least == DVI__SAID) steps.value[k] = method->keys[k].default_value;
  return dvi__spell_out(method, &steps);
}
