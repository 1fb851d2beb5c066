/* Specifications: name[:key=value,...]. */
#include <dvi/method.h>
#include <dvi/number.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "core/status.h"
#include "method/method.h"

void dvi__text_add(dvi__text *text, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  const size_t room = text->length < text->size ? text->size - text->length : 0;
  const int length = dvi_number_vprint(room > 0 ? text->text + text->length : NULL, room, format, arguments);
  va_end(arguments);
  if (length > 0) text->length += (size_t)length;
}

/* A piece of a specification, not ended by 0. */
typedef struct piece {
  const char *text;
  int length;
} piece;

static int same(piece given, const char *word)
{
  return (int)strlen(word) == given.length && strncmp(word, given.text, (size_t)given.length) == 0;
}

static const char *end_of(const char *text, const char *stops)
{
  return text + strcspn(text, stops);
}

static dvi_status unknown_key(const dvi__method *method, piece name)
{
  char known[DVI__SENTENCE_SIZE] = "";
  dvi__text text = {known, sizeof known, 0};
  for (int k = 0; k < dvi__key_count(method); k++) dvi__text_add(&text, "%s%s", k > 0 ? ", " : "", method->keys[k].name);
  if (method->list != NULL) dvi__text_add(&text, ", %s", method->list);
  return dvi__fail(DVI_BAD_OPTION, "%s: unknown key '%.*s'; %s%s", method->name, name.length, name.text,
                   text.length > 0 ? "it takes " : "it takes none", known);
}

/* One spelling of each number: no sign, no blank, no leading zero, all of which strtol would take. The length of the digits, 0 if there is none such. */
static int plain_digits(const char *text)
{
  const int digits = (int)strspn(text, "0123456789");
  return text[0] != '0' || digits == 1 ? digits : 0;
}

enum { LONGEST_DECIMAL = 15 }; /* as many digits a double keeps */

/* The same with decimals, of which the last is not 0. */
static int plain_decimal(const char *text)
{
  const int whole = plain_digits(text);
  if (whole == 0 || text[whole] != '.') return whole;
  const int decimals = (int)strspn(text + whole + 1, "0123456789");
  return decimals > 0 && text[whole + decimals] != '0' ? whole + 1 + decimals : 0;
}

static dvi_status parse_number(const dvi__method *method, const dvi__key *key, piece value, int *number)
{
  if (plain_digits(value.text) != value.length || value.length == 0)
    return dvi__fail(DVI_BAD_OPTION, "%s: %s=%.*s is not a whole number in plain digits", method->name, key->name, value.length,
                     value.text);
  const long parsed = strtol(value.text, NULL, 10); /* LONG_MAX if it is beyond */
  if (parsed < key->least || parsed > key->most)
    return dvi__fail(DVI_BAD_OPTION, "%s: %s=%.*s; %d to %d are possible", method->name, key->name, value.length, value.text,
                     key->least, key->most);
  *number = (int)parsed;
  return DVI_OK;
}

static dvi_status parse_list(const dvi__method *method, piece value, dvi__settings *settings)
{
  if (settings->listed > 0) return dvi__fail(DVI_BAD_OPTION, "%s: %s is given twice", method->name, method->list);
  const char *end = value.text + value.length;
  for (const char *at = value.text;; at++) {
    const int length = plain_decimal(at);
    if (length == 0 || length > LONGEST_DECIMAL || (at + length != end && at[length] != ':'))
      return dvi__fail(DVI_BAD_OPTION,
                       "%s: %s=%.*s is not a list of numbers in plain digits, such as 2 or 1:0.5; positive ones of at most %d "
                       "characters are possible, without sign, exponent, or zeros at the ends",
                       method->name, method->list, value.length, value.text, LONGEST_DECIMAL);
    if (settings->listed == DVI__LIST_MOST)
      return dvi__fail(DVI_BAD_OPTION, "%s: %s has more than %d numbers; 1 to %d are possible", method->name, method->list,
                       DVI__LIST_MOST, DVI__LIST_MOST);
    (void)dvi_number_read(at, &settings->list[settings->listed++]);
    at += length;
    if (at == end) break;
  }
  /* It fits: at most DVI__LIST_MOST numbers of LONGEST_DECIMAL characters, and their colons. */
  memcpy(settings->list_text, value.text, (size_t)value.length);
  return DVI_OK;
}

static dvi_status parse_choice(const dvi__method *method, const dvi__key *key, piece value, int *choice)
{
  char known[DVI__SENTENCE_SIZE] = "";
  dvi__text text = {known, sizeof known, 0};
  for (int c = 0; key->choice(c) != NULL; c++) {
    if (same(value, key->choice(c))) {
      *choice = c;
      return DVI_OK;
    }
    dvi__text_add(&text, "%s%s", c > 0 ? ", " : "", key->choice(c));
  }
  if (key->most > 0) dvi__text_add(&text, " and %d to %d", key->least, key->most);
  return dvi__fail(DVI_BAD_OPTION, "%s: %s=%.*s; possible are %s", method->name, key->name, value.length, value.text, known);
}

/* A key may take names beside numbers. */
static int is_number(const dvi__key *key, piece value)
{
  return key->choice == NULL || (key->most > 0 && value.length > 0 && value.text[0] >= '0' && value.text[0] <= '9');
}

static dvi_status parse_real(const dvi__method *method, const dvi__key *key, piece value, double *number)
{
  *number = 0;
  if (same(value, "auto")) return DVI_OK;
  const char *end = dvi_number_read(value.text, number);
  if (value.length > 0 && end == value.text + value.length && isfinite(*number) && *number > 0) return DVI_OK;
  return dvi__fail(DVI_BAD_OPTION, "%s: %s=%.*s; a positive number is possible, or auto", method->name, key->name, value.length,
                   value.text);
}

static dvi_status keep_text(const dvi__method *method, const dvi__key *key, piece value, dvi__settings *settings)
{
  if (value.length == 0)
    return dvi__fail(DVI_BAD_OPTION, "%s: %s= is empty; give it a text, or leave it out", method->name, key->name);
  dvi__text text = {settings->text, sizeof settings->text, 0};
  dvi__text_add(&text, "%.*s", value.length, value.text);
  return text.length < text.size ? DVI_OK : dvi__fail(DVI_BAD_OPTION, "%s: the specification is too long", method->name);
}

static dvi_status keep_for_others(const dvi__method *method, piece name, piece value, dvi__settings *settings)
{
  dvi__text rest = {settings->rest, sizeof settings->rest, strlen(settings->rest)};
  dvi__text_add(&rest, "%s%.*s=%.*s", rest.length > 0 ? "," : "", name.length, name.text, value.length, value.text);
  if (rest.length < rest.size) return DVI_OK;
  return dvi__fail(DVI_BAD_OPTION, "%s: the specification is too long", method->name);
}

static dvi_status assign(const dvi__method *method, piece name, piece value, dvi__settings *settings, unsigned *given)
{
  for (int k = 0; k < dvi__key_count(method); k++) {
    const dvi__key *key = &method->keys[k];
    if (!same(name, key->name)) continue;
    if (*given & 1U << k) return dvi__fail(DVI_BAD_OPTION, "%s: %s is given twice", method->name, key->name);
    *given |= 1U << k;
    if (key->least == DVI__POSITIVE) return parse_real(method, key, value, &settings->number[k]);
    if (key->least == DVI__TEXT) return keep_text(method, key, value, settings);
    return is_number(key, value) ? parse_number(method, key, value, &settings->value[k])
                                 : parse_choice(method, key, value, &settings->value[k]);
  }
  if (method->list != NULL && same(name, method->list)) return parse_list(method, value, settings);
  return method->takes_rest ? keep_for_others(method, name, value, settings) : unknown_key(method, name);
}

/* A text that is no name shall not push the names that there are out of the sentence. */
enum { LONGEST_SHOWN = 80 };

static dvi_status unknown_method(piece name)
{
  char known[DVI__SENTENCE_SIZE] = "";
  dvi__text text = {known, sizeof known, 0};
  for (int i = 0; i < dvi_method_count(); i++) dvi__text_add(&text, "%s%s", i > 0 ? ", " : "", dvi_method_name(i));
  const int shown = name.length < LONGEST_SHOWN ? name.length : LONGEST_SHOWN;
  return dvi__fail(DVI_BAD_OPTION, "unknown method '%.*s'; there are %s", shown, name.text, known);
}

/* The key and the value behind a colon or comma; a value without text if there is none. Returns where they end. */
static const char *take_pair(const char *at, piece *name, piece *value)
{
  const char *start = at + 1, *equals = end_of(start, "=,"), *end = end_of(equals, ",");
  *name = (piece){start, (int)(equals - start)};
  *value = *equals == '=' && equals > start ? (piece){equals + 1, (int)(end - equals - 1)} : (piece){0};
  return end;
}

static int names_file(const dvi__method *method, piece name)
{
  for (int k = 0; k < dvi__key_count(method); k++)
    if (same(name, method->keys[k].name)) return method->keys[k].least == DVI__TEXT;
  return 0;
}

/* Keys that a method hands on may be those of any other one. */
static int may_name_file(const dvi__method *method, piece name)
{
  int found = names_file(method, name);
  for (int i = 0; method->takes_rest && i < dvi_method_count(); i++)
    found |= names_file(dvi__find_method(dvi_method_name(i), strlen(dvi_method_name(i))), name);
  return found;
}

const char *dvi_method_file(const char *specification, size_t *length)
{
  const char *at = specification != NULL ? end_of(specification, ":") : "";
  const dvi__method *method = *at != 0 ? dvi__find_method(specification, (size_t)(at - specification)) : NULL;
  *length = 0;
  while (method != NULL && *at != 0) {
    piece name, value;
    at = take_pair(at, &name, &value);
    if (value.length == 0 || !may_name_file(method, name)) continue;
    *length = (size_t)value.length;
    return value.text;
  }
  return NULL;
}

dvi_status dvi__parse(const char *specification, const dvi__method **method, dvi__settings *settings)
{
  unsigned given = 0;
  const char *at = end_of(specification, ":");
  const piece method_name = {specification, (int)(at - specification)};
  *method = dvi__find_method(specification, (size_t)(at - specification));
  if (*method == NULL) return unknown_method(method_name);
  *settings = (dvi__settings){0};
  for (int k = 0; k < dvi__key_count(*method); k++) settings->value[k] = (*method)->keys[k].left_out;
  while (*at != 0) {
    piece name, value;
    const char *end = take_pair(at, &name, &value);
    if (value.text == NULL)
      return dvi__fail(DVI_BAD_OPTION, "%s: '%.*s' is not key=value", (*method)->name, (int)(end - name.text), name.text);
    DVI_TRY(assign(*method, name, value, settings, &given));
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

void dvi__spell_out(const dvi__method *method, const dvi__settings *settings, dvi__text *text)
{
  dvi__text_add(text, "%s", method->name);
  for (int k = 0; k < dvi__key_count(method); k++) {
    const dvi__key *key = &method->keys[k];
    if (key->least == DVI__TEXT && settings->text[0] == 0) continue;
    dvi__text_add(text, "%c%s=", k == 0 ? ':' : ',', key->name);
    if (key->least == DVI__POSITIVE)
      spell_real(settings->number[k], text);
    else if (key->least == DVI__TEXT)
      dvi__text_add(text, "%s", settings->text);
    else if (key->choice != NULL && key->choice(settings->value[k]) != NULL)
      dvi__text_add(text, "%s", key->choice(settings->value[k]));
    else
      dvi__text_add(text, "%d", settings->value[k]);
  }
  if (settings->listed > 0) dvi__text_add(text, ",%s=%s", method->list, settings->list_text);
  if (settings->rest[0] != 0) dvi__text_add(text, "%c%s", dvi__key_count(method) == 0 ? ':' : ',', settings->rest);
}

static dvi_status spell_steps(const char *specification, dvi__text *text)
{
  const dvi__method *method;
  dvi__settings settings;
  DVI_TRY(dvi__parse(specification, &method, &settings));
  for (int k = 0; k < dvi__key_count(method); k++)
    if (method->keys[k].least == DVI__SAID) settings.value[k] = method->keys[k].left_out;
  dvi__spell_out(method, &settings, text);
  return DVI_OK;
}

int dvi__same_steps(const char *one, const char *other)
{
  char spelled[2][DVI__SPECIFICATION_SIZE] = {"", ""};
  return spell_steps(one, &(dvi__text){spelled[0], DVI__SPECIFICATION_SIZE, 0}) == DVI_OK &&
         spell_steps(other, &(dvi__text){spelled[1], DVI__SPECIFICATION_SIZE, 0}) == DVI_OK && strcmp(spelled[0], spelled[1]) == 0;
}
