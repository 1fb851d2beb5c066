/** The module dvi_hdf5, which writes and reads files of HDF5.
 *
 *  The command loads it when a file of HDF5 is named: libhdf5 brings so many libraries along that a
 *  command linked to it would take three times as long to start. Functions that fail return NULL or
 *  false, and `reason` says why. */
#ifndef HDF5_MODULE_H
#define HDF5_MODULE_H
#include <stdbool.h>
#include <stdint.h>

/** A fact about what a file holds, an attribute of its root: a text, or a number. */
typedef struct hdf5_fact {
  const char *name;
  const char *text; /**< NULL for a number */
  double number;
  bool decides; /**< rows are appended only to a file in which it is the same */
} hdf5_fact;

/** What is known before the first row. */
typedef struct hdf5_head {
  const char *layout; /**< what the file holds, such as "dvi rows 1" */
  int facts;
  const hdf5_fact *fact; /**< [facts] */
  int columns;
  const char *const *column; /**< [columns] names */
  double expected;           /**< number of rows, as far as it can be told */
} hdf5_head;

/** A state from which rows go on. The first column is the time. */
typedef struct hdf5_state {
  double t;
  double direction; /**< 1, or -1 for a run backward */
  double gap;       /**< largest distance of the row before the state, if that has none */
  bool has_row;     /**< an uninterrupted run has a row at the state */
} hdf5_state;

/** A file with the dataset `rows`, which grows. */
typedef struct hdf5_rows hdf5_rows;

/** Columns of text beside those of numbers. */
typedef struct hdf5_texts {
  int columns;
  const char *const *column; /**< [columns] names */
  const char *const *cell;   /**< [rows*columns] */
} hdf5_texts;

/** A grid of cells of one kind. */
typedef struct hdf5_grid {
  int64_t points, cells;
  int corners, type;     /**< of a cell: number of its points, and number of its kind in VTK */
  const double *point;   /**< [points*3] */
  const int64_t *vertex; /**< [cells*corners] */
} hdf5_grid;

/** Values at the points or in the cells of a grid. */
typedef struct hdf5_field {
  const char *name;
  int components;
  bool is_by_cell;
  const double *value; /**< [points or cells][components]. Or else: */
  /** Give rows of the values, which are asked for in their order. */
  bool (*read)(const struct hdf5_field *field, int64_t first, int64_t rows, double *value);
  const void *of;
} hdf5_field;

/** A file with the group VTKHDF, an unstructured grid with fields that change. */
typedef struct hdf5_frames hdf5_frames;

/** A file of rows or of a table, to be read. */
typedef struct hdf5_source hdf5_source;

/** What such a file holds. */
typedef struct hdf5_content {
  bool is_table; /**< of a sweep, and no rows of a run */
  int64_t rows;
  int columns;
  const char *const *column; /**< [columns] names of the columns of numbers, until it is closed */
} hdf5_content;

/** A file of fields, to be read. */
typedef struct hdf5_views hdf5_views;

/** What such a file holds, until it is closed. */
typedef struct hdf5_views_content {
  int64_t steps;
  const double *time; /**< [steps] */
  hdf5_grid grid;     /**< without its points */
  int fields;
  const hdf5_field *field; /**< [fields] without their values, those of the points first */
} hdf5_views_content;

/** The functions of the module. */
typedef struct hdf5_module {
  /** Return why the last function failed, half a sentence. */
  const char *(*reason)(void);

  /** Create a file without rows. */
  hdf5_rows *(*create_rows)(const char *path, const hdf5_head *head);

  /** Open a file whose writer has ended or was killed, and cut off the rows behind the state. A
   * file with another head, or with rows that do not reach the state, is refused and not changed.
   *
   *  @param[out] has_row  the last row is that of the state */
  hdf5_rows *(*append_rows)(const char *path, const hdf5_head *head, const hdf5_state *state,
                            bool *has_row);

  /** Add a row [columns]. Rows are written in blocks, and flushed once a second at most. */
  bool (*add_row)(hdf5_rows *rows, const double *row);

  /** Write all rows so far, so that a reader sees them, even if this process is killed. */
  bool (*flush_rows)(hdf5_rows *rows);

  /** Write all rows, and close the file. The pointer becomes NULL in any case. */
  bool (*close_rows)(hdf5_rows **rows);

  /** Write a table: numbers [rows*columns] as the dataset `rows`, and texts as the datasets of the
   * group `text`. */
  bool (*write_table)(const char *path, const hdf5_head *head, int64_t rows, const double *number,
                      const hdf5_texts *texts);

  /** Open a file of rows or a table to read. Its run may go on, or have been killed: then these are
   * the rows that were flushed. */
  hdf5_source *(*open_source)(const char *path, hdf5_content *content);

  /** Read rows [count*columns] from `first` on. */
  bool (*read_rows)(hdf5_source *source, int64_t first, int64_t count, double *number);

  /** Close the file. The pointer becomes NULL. */
  void (*close_source)(hdf5_source **source);

  /** Create a file for fields on a grid, of which nothing is written yet. */
  hdf5_frames *(*create_frames)(const char *path, const hdf5_head *head, const hdf5_grid *grid,
                                int fields, const hdf5_field *field);

  /** Add the fields at a time. A grid is given with the first ones, and wherever it has moved: with
   * other points, but the same cells. NULL if it has not. */
  bool (*add_frame)(hdf5_frames *frames, double t, const hdf5_grid *grid, const hdf5_field *field);

  /** Close the file. The pointer becomes NULL in any case. */
  bool (*close_frames)(hdf5_frames **frames);

  /** Open a file of fields to read. Its run may go on, or have been killed: then these are the
   * times that were flushed. Numbers of corners, and of points that cells name, are not tested. */
  hdf5_views *(*open_views)(const char *path, hdf5_views_content *content);

  /** Read the points [points*3] and the values of all fields, each [points or cells][components],
   * at a step. */
  bool (*read_view)(hdf5_views *views, int64_t step, double *point, double *const *value);

  /** Close the file. The pointer becomes NULL. */
  void (*close_views)(hdf5_views **views);
} hdf5_module;

/** The module's only symbol. */
extern const hdf5_module dvi_hdf5 __attribute__((visibility("default")));
#endif
