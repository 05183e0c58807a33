"""Importing the graph layer does not load the libraries that it uses."""

import pkgutil
import subprocess
import sys

import robbdd_tools.graph


def test_no_module_loads_a_graph_library_when_it_is_imported() -> None:
    modules = [info.name for info in pkgutil.walk_packages(robbdd_tools.graph.__path__, "robbdd_tools.graph.")]
    script = f"import sys, {', '.join(modules)}; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout.split()
    assert {"rdflib", "pyshacl", "pyld"}.isdisjoint(loaded)
    assert len(modules) > 10
