"""Build dvi._dvi, the C part of the package, by cffi in API mode.

The public headers are the declarations: the C preprocessor leaves of them what cffi reads. The
library is found by pkg-config (dvi-scene, dvi-study). DVI_INCLUDE and DVI_LIBRARY name the folders
of a build that is not installed. The module finds the library there at run time, too, or in
DVI_RUNPATH, or, if that is empty, where the loader looks.
"""
import os
import pathlib
import re
import subprocess
import tempfile

import cffi

# Headers with functions in them, which cffi does not read. Nothing in the package needs them.
INLINE = ["TAYLOR", "SINES", "NUMBER"]
STANDARD = ["math", "stdarg", "stddef", "stdint", "string"]

CDEF = """
dvi_status interruptible_record(dvi_integrator *, const dvi_run_options *,
                                const dvi_record_options *, dvi_recording **, int *interrupted);
dvi_status interruptible_sweep(const dvi_study_sweep_options *, int *interrupted);
dvi_status interruptible_march(dvi_march *, const dvi_march_record_options *, dvi_recording **,
                               int *interrupted);
"""

SOURCE = r"""
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <dvi/study.h>
#include <signal.h>

static volatile int cancelled;
static int depth; /* of runs that callbacks of runs begin, all on the main thread */

static void cancel(int number) { (void)number; cancelled = 1; }

static int catch_interrupts(struct sigaction *before)
{
  struct sigaction during = {.sa_handler = cancel};
  (void)sigemptyset(&during.sa_mask);
  if (depth++ == 0) cancelled = 0;
  return sigaction(SIGINT, &during, before) == 0;
}

static int release_interrupts(int is_caught, const struct sigaction *before)
{
  if (is_caught) (void)sigaction(SIGINT, before, NULL);
  depth--;
  return cancelled;
}

/* Record a run, which Ctrl-C ends after its step if *interrupted is not 0. Then it tells whether it
 * did. That is for the main thread. */
static dvi_status interruptible_record(dvi_integrator *integrator, const dvi_run_options *run,
                                       const dvi_record_options *options,
                                       dvi_recording **recording, int *interrupted)
{
  if (!*interrupted) return dvi_record(integrator, run, options, recording);
  struct sigaction before;
  const int is_caught = catch_interrupts(&before);
  dvi_run_options own = *run;
  own.cancel = &cancelled;
  const dvi_status status = dvi_record(integrator, &own, options, recording);
  *interrupted = release_interrupts(is_caught, &before);
  return status;
}

/* Do the same for a sweep. */
static dvi_status interruptible_sweep(const dvi_study_sweep_options *options, int *interrupted)
{
  if (!*interrupted) return dvi_study_sweep(options, NULL);
  struct sigaction before;
  const int is_caught = catch_interrupts(&before);
  dvi_study_sweep_options own = *options;
  own.cancel = &cancelled;
  const dvi_status status = dvi_study_sweep(&own, NULL);
  *interrupted = release_interrupts(is_caught, &before);
  return status;
}

/* Do the same for a march. */
static dvi_status interruptible_march(dvi_march *march, const dvi_march_record_options *options,
                                      dvi_recording **recording, int *interrupted)
{
  if (!*interrupted) return dvi_march_record(march, options, recording);
  struct sigaction before;
  const int is_caught = catch_interrupts(&before);
  dvi_march_record_options own = *options;
  own.cancel = &cancelled;
  const dvi_status status = dvi_march_record(march, &own, recording);
  *interrupted = release_interrupts(is_caught, &before);
  return status;
}
"""


def flags(option):
    """Return the folders that pkg-config names."""
    try:
        said = subprocess.run(["pkg-config", option, "dvi-scene", "dvi-study"],
                              capture_output=True, text=True)
    except FileNotFoundError:
        return []
    return [os.path.realpath(word[2:]) for word in said.stdout.split()]


def folders(variable, option):
    """Return the folder that the environment names, or those of the installed library."""
    named = os.environ.get(variable)
    return [os.path.abspath(named)] if named else flags(option)


def declarations(include):
    """Return the declarations of all public headers."""
    with tempfile.TemporaryDirectory() as folder:
        for name in STANDARD:
            pathlib.Path(folder, name + ".h").touch()
        command = [os.environ.get("CC", "cc"), "-E", "-P", "-nostdinc", "-I" + folder]
        command += ["-I" + path for path in include]
        command += [f"-DDVI_{name}_H" for name in INLINE] + ["-"]
        text = "#include <dvi/dvi.h>\n#include <dvi/scene.h>\n#include <dvi/study.h>\n"
        said = subprocess.run(command, input=text, capture_output=True, text=True)
    if said.returncode:
        raise SystemExit(said.stderr + "libdvi is not found: install it, with pkg-config, "
                         "name the folder of its dvi-study.pc in PKG_CONFIG_PATH, or its folders "
                         "in DVI_INCLUDE and DVI_LIBRARY (docs/python.md).")
    # cffi cannot compile pointers to constant arrays, and leaves such members out.
    return re.sub(r"const \w+ \(\*\w+\)\[\d\];", "...;", said.stdout)


include = folders("DVI_INCLUDE", "--cflags-only-I") or ["/usr/local/include", "/usr/include"]
library = folders("DVI_LIBRARY", "--libs-only-L")
runpath = os.environ["DVI_RUNPATH"].split() if "DVI_RUNPATH" in os.environ else library
ffibuilder = cffi.FFI()
ffibuilder.cdef(declarations(include))
ffibuilder.cdef(CDEF)
ffibuilder.set_source("dvi._dvi", SOURCE, include_dirs=include, library_dirs=library,
                      runtime_library_dirs=runpath, libraries=["dvi-study", "dvi-scene", "dvi"])

if __name__ == "__main__":
    ffibuilder.compile(verbose=False)
