"""gmsh started and ended without side effects on the calling program."""

import inspect
import signal
import threading
from contextlib import contextmanager

OPTIONS = {
    "General.Terminal": 0,
    "General.NumThreads": 1,
    "Mesh.MeshSizeExtendFromBoundary": 0,
    "Mesh.MeshSizeFromPoints": 0,
    "Mesh.MeshSizeFromCurvature": 0,
    "Mesh.ElementOrder": 1,
    "Mesh.Algorithm": 6,  # frontal Delaunay; 8 crashes gmsh 4.8.4
    "Mesh.RecombinationAlgorithm": 1,
}


@contextmanager
def gmsh_model(name: str):
    """The gmsh module with an empty model of that name and this program's options; removed afterwards. A gmsh that the
    caller has already started stays up, its own models untouched."""
    import gmsh

    started_here = not _is_running(gmsh)
    if started_here:
        start(gmsh)
    saved = {} if started_here else {key: gmsh.option.getNumber(key) for key in OPTIONS}
    try:
        gmsh.model.add(name)
        for key, value in OPTIONS.items():
            gmsh.option.setNumber(key, value)
        yield gmsh
    finally:
        if started_here:
            gmsh.finalize()
        else:
            gmsh.model.remove()
            for key, value in saved.items():
                gmsh.option.setNumber(key, value)


def _is_running(gmsh) -> bool:
    # gmsh 4.8 has no such query; it counts as not running.
    return hasattr(gmsh, "isInitialized") and bool(gmsh.isInitialized())


def start(gmsh) -> None:
    """Start gmsh from any thread, with no handler of Ctrl-C of its own."""
    options = {"readConfigFiles": False}
    if "interruptible" in inspect.signature(gmsh.initialize).parameters:
        options["interruptible"] = False
    in_main_thread = threading.current_thread() is threading.main_thread()
    handler = signal.getsignal(signal.SIGINT)
    gmsh.initialize(**options)
    # Versions without `interruptible` may replace the handler, and Ctrl-C would end the run without saving.
    if in_main_thread and handler is not None and signal.getsignal(signal.SIGINT) is not handler:
        signal.signal(signal.SIGINT, handler)
