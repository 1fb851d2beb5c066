#include "hdf5/h5.h"
#include "hdf5/hdf5_module.h"
#include "hdf5/read_frames.h"
#include "hdf5/read_rows.h"
#include "hdf5/stored_frames.h"
#include "hdf5/stored_rows.h"

const hdf5_module dvi_hdf5 = {
    .reason = h5_reason,
    .create_rows = stored_rows_create,
    .append_rows = stored_rows_append,
    .add_row = stored_rows_add,
    .flush_rows = stored_rows_flush,
    .close_rows = stored_rows_close,
    .write_table = stored_table,
    .open_source = read_rows_open,
    .read_rows = read_rows_read,
    .close_source = read_rows_close,
    .create_frames = stored_frames_create,
    .add_frame = stored_frames_add,
    .close_frames = stored_frames_close,
    .open_views = read_frames_open,
    .read_view = read_frames_read,
    .close_views = read_frames_close,
};
