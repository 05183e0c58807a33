"""The rules of ARCHITECTURE.md that can be read off the source."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections import Counter
from collections.abc import Container, Iterator, Mapping
from functools import cache
from pathlib import Path

import pytest

import robbdd_tools

PACKAGE = Path(robbdd_tools.__file__).parent
ROOT = PACKAGE.parent.parent
LAYERS: tuple[frozenset[str], ...] = (
    frozenset({"base"}),
    frozenset({"catalog.api"}),
    frozenset({"monitor"}),
    frozenset({"catalog"}),
    frozenset({"protocol"}),
    frozenset({"traces"}),
    frozenset({"logs"}),
    frozenset({"syntax"}),
    frozenset({"names"}),
    frozenset({"graph"}),
    frozenset({"checks", "features", "gherkin"}),
    frozenset({"run"}),
    frozenset({"workbench"}),
    frozenset({"campaign"}),
    frozenset({"lsp", "dap", "cli", "commands", "pytest_plugin"}),
    frozenset({"start"}),
)
EVIDENCE = {"base", "catalog.api", "monitor", "catalog", "protocol", "traces", "logs"}
BRANCH: dict[str, set[str]] = {
    "user_code": EVIDENCE,
    "judging": {*EVIDENCE, "user_code"},
    "world": {*EVIDENCE, "user_code"},
    "agent": {*EVIDENCE, "user_code", "judging", "world"},
}
"""The layers of the agent process, and what each may import; nothing outside of the branch imports them."""
HOMES = {
    "textx": {"syntax"},
    "rapidfuzz": {"names"},
    "rdflib": {"graph"},
    "pyparsing": {"graph"},
    "pyshacl": {"graph"},
    "covertable": {"gherkin"},
    "pyld": {"graph"},
    "jinja2": {"gherkin", "campaign"},
    "behave": {"agent"},
    "mujoco": {"world"},
    "mcap": {"traces", "logs"},
    "rosbags": {"logs"},
    "google": {"logs"},
    "debugpy": {"agent"},
    "sqlite3": {"run", "logs"},
    "py_trees": {"agent"},
    "pygls": {"lsp"},
    "lsprotocol": {"lsp"},
    "rich": {"commands"},
    "shtab": {"commands"},
    "scipy": {"campaign"},
    "distributed": {"campaign"},
    "duckdb": {"campaign", "logs"},
    "reqif": {"workbench"},
    "trimesh": {"world"},
    "collada": {"world"},
    "cmaes": {"campaign"},
    "pytest": {"pytest_plugin"},
    "msgpack": {"user_code"},
    "websockets": {"user_code"},
}
# Packages of one rank that may import each other; all others of one rank may not.
NEIGHBOURS = {("features", "checks"), ("cli", "commands"), ("commands", "cli"), ("commands", "dap")}


def modules() -> Iterator[tuple[str, Path]]:
    for path in sorted(PACKAGE.rglob("*.py")):
        yield ".".join(path.relative_to(PACKAGE).with_suffix("").parts).removesuffix(".__init__"), path


@cache
def nodes(path: Path) -> tuple[ast.AST, ...]:
    """Return all nodes of a file: to parse it takes longer than to check the rules."""
    return tuple(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))


def imports(path: Path) -> Iterator[str]:
    for node in nodes(path):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"relative import in {path}"
            yield node.module or ""


def layer(module: str) -> str:
    return "catalog.api" if module == "catalog.api" else module.partition(".")[0]


def rank(name: str) -> int:
    return next(index for index, names in enumerate(LAYERS) if name in names)


def own_imports(path: Path) -> Iterator[str]:
    prefix = "robbdd_tools."
    yield from (name.removeprefix(prefix) for name in imports(path) if name.startswith(prefix))


def forbidden_imports(module: str, path: Path) -> Iterator[str]:
    own = layer(module)
    for target in own_imports(path):
        other = layer(target)
        if own in BRANCH:
            allowed = other == own or other in BRANCH[own]
        else:
            same_rank = other == own or (own, other) in NEIGHBOURS
            allowed = other not in BRANCH and (same_rank or rank(other) < rank(own))
        if not allowed:
            yield f"{module} imports {target}"


def test_a_module_imports_only_from_layers_to_its_left() -> None:
    layered = [(module, path) for module, path in modules() if "." in module or module in ("cli", "start")]
    assert [fault for module, path in layered for fault in forbidden_imports(module, path)] == []


OBJECTS_OF_THE_API = {"workbench.model", "workbench.plan", "workbench.run"}
"""Public types that refer to each other: a model has plans, a plan has runs, and each refers back."""
HUB_OF_THE_SERVER = "lsp.server"
"""The server's parts know the server, which holds them."""


def imported_modules(path: Path, known: Container[str]) -> Iterator[str]:
    """Yield the modules of ours that a module imports, those for types and inside functions included."""
    for node in nodes(path):
        if isinstance(node, ast.ImportFrom) and node.module:
            package = node.module.removeprefix("robbdd_tools.")
            for alias in node.names:
                inner = f"{package}.{alias.name}"
                yield inner if inner in known else package


def circles(graph: Mapping[str, set[str]]) -> list[list[str]]:
    """Return the modules that import each other, if only by way of others."""
    left = {module: set(targets) for module, targets in graph.items()}
    while ends := {module for module, targets in left.items() if not targets & left.keys()}:
        left = {module: targets for module, targets in left.items() if module not in ends}
    while beginnings := left.keys() - {target for targets in left.values() for target in targets}:
        left = {module: targets for module, targets in left.items() if module not in beginnings}
    return [sorted(left)] if left else []


def test_no_imports_go_in_a_circle() -> None:
    known = dict(modules())
    graph = {module: {name for name in imported_modules(path, known) if name != module} for module, path in modules()}
    graph[HUB_OF_THE_SERVER] = set()
    for module in OBJECTS_OF_THE_API:
        graph[module] -= OBJECTS_OF_THE_API
    assert circles(graph) == []


SAME_ROLE = {
    "__main__": "what `python -m` executes",
    **dict.fromkeys(
        (
            "behaviour_trees",
            "clauses",
            "executions",
            "instances",
            "named_predicates",
            "requirements",
            "robot_logs",
            "scenes",
            "stories",
            "variations",
        ),
        "one part of a model: written to the graph, read from it, expanded, or made text again",
    ),
    **dict.fromkeys(
        ("graph_picture", "preview", "user_errors", "layout", "query", "judge", "run", "runs", "steps", "diagnostics"),
        "one feature: what it does in the core, and how the server, a command or a program asks for it",
    ),
    "pick_place": "one behaviour: its words in the catalog, its controller in the world",
    "pose": "where something is: the type, and the diagnostic of a pose that is none",
}


def test_a_file_name_stands_once_or_means_one_thing() -> None:
    names = Counter(path.stem for _, path in modules() if path.stem != "__init__")
    assert {name for name, count in names.items() if count > 1} == set(SAME_ROLE)


def test_a_library_has_one_home() -> None:
    assert [
        f"{module} imports {name}"
        for module, path in modules()
        for name in imports(path)
        if layer(module) not in HOMES.get(name.partition(".")[0], {layer(module)})
    ] == []


def test_modules_stay_readable_in_one_sitting() -> None:
    lengths = {module: len(path.read_text(encoding="utf-8").splitlines()) for module, path in modules()}
    assert {module: length for module, length in lengths.items() if length > 350} == {}


MAY_PLAN = {"run", "workbench"}
PLANNING = {"Scheduler", "RunRequest", "SpecWriter", "Recording", "Relations", "prepare_all", "scenario_seed"}
"""What plans and executes runs."""


def plans(path: Path) -> Iterator[str]:
    """Yield the runtime imports of a module for planning or executing runs."""
    for_types = {
        id(node)
        for block in nodes(path)
        if isinstance(block, ast.If) and ast.unparse(block.test) == "TYPE_CHECKING"
        for node in ast.walk(block)
    }
    for node in nodes(path):
        if isinstance(node, ast.ImportFrom) and id(node) not in for_types:
            yield from PLANNING.intersection(alias.name for alias in node.names)


def test_runs_are_planned_and_executed_by_the_workbench_alone() -> None:
    """The command line, the server and the pytest plugin turn their arguments into selections and show results."""
    others = [(module, path) for module, path in modules() if layer(module) not in MAY_PLAN | BRANCH.keys()]
    found = {module: set(plans(path)) for module, path in others}
    assert {module: names for module, names in found.items() if names} == {}
    homes = {"run.prepare", "run.scheduler", "run.scenario_specs", "run.tree_specs", "run.recording", "run.launch"}
    server = {module: homes.intersection(own_imports(path)) for module, path in others if layer(module) == "lsp"}
    assert {module: names for module, names in server.items() if names} == {}


STARTS_PROCESSES = {
    *(f"subprocess.{name}" for name in ("run", "Popen", "call", "check_call", "check_output", "getoutput")),
    *(f"asyncio.create_subprocess_{name}" for name in ("exec", "shell")),
    *(f"os.{name}" for name in ("system", "popen", "fork", "posix_spawn", "startfile", "execv", "execve", "spawnv")),
}
MAY_START_PROCESSES = {"base.interpreter", "base.processes", "user_code.system_links"}
"""The first starts interpreters, isolated from the working directory; the second starts a program of Windows; the third
starts users' programs, which are users' code."""


def started_processes(path: Path) -> Iterator[str]:
    for node in nodes(path):
        if isinstance(node, ast.Attribute) and ast.unparse(node) in STARTS_PROCESSES:
            yield ast.unparse(node)
        elif isinstance(node, ast.ImportFrom) and node.module in ("subprocess", "asyncio.subprocess", "os"):
            yield from (alias.name for alias in node.names if f"{node.module}.{alias.name}" in STARTS_PROCESSES)
    yield from {"multiprocessing", "runpy", "pty"}.intersection(imports(path))


def test_interpreters_are_started_in_one_place() -> None:
    found = {module: list(started_processes(path)) for module, path in modules() if module not in MAY_START_PROCESSES}
    assert {module: names for module, names in found.items() if names} == {}


def loaded_after(code: str) -> set[str]:
    script = f"import sys\n{code}\nprint(*sorted(name for name in sys.modules if '.' not in name))"
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    return set(result.stdout.split())


@pytest.mark.parametrize(
    "code",
    [
        "from robbdd_tools.lsp.handlers import create_server; create_server()",
        "import robbdd_tools.cli, robbdd_tools.commands.check",
        "import robbdd_tools.pytest_plugin",
    ],
)
def test_heavy_libraries_wait_until_they_are_needed(code: str) -> None:
    assert loaded_after(code).isdisjoint({"rdflib", "pyshacl", "pyld", "mujoco", "behave", "jinja2", "numpy"})


def test_the_version_is_told_without_loading_anything() -> None:
    loaded = loaded_after("from robbdd_tools.cli import main\ntry: main(['--version'])\nexcept SystemExit: pass")
    assert loaded.isdisjoint({"textx", "rdflib", "pygls", "rich", "numpy", "mujoco"})


def prints(path: Path) -> Iterator[str]:
    """Return the calls with which a module prints: ``print``, a standard stream's ``write``, its own console."""
    for node in nodes(path):
        if isinstance(node, ast.Call):
            called = ast.unparse(node.func)
            if called in ("print", "sys.stdout.write", "sys.stderr.write", "Console") or called.endswith(".Console"):
                yield called


def test_commands_print_only_through_what_escapes() -> None:
    homes = {"commands.output": {"print", "sys.stdout.write"}, "commands.terminal": {"Console"}}
    found = {module: set(prints(path)) for module, path in modules() if layer(module) in ("commands", "cli")}
    assert {module: used for module, used in found.items() if not used <= homes.get(module, set())} == {}


SYSTEM_MODULES = {"signal", "fcntl", "msvcrt", "resource", "select", "termios", "pty", "ctypes", "winreg"}
SYSTEM_CALLS = {f"os.{name}" for name in ("kill", "killpg", "fork", "nice", "setsid", "waitpid", "mkfifo", "getuid")}
SYSTEM_NAMES = {"sys.platform", "os.name", "platform.system"}
SYSTEM_HOMES = {
    "base.processes",
    "base.descendants",
    "base.interruptible_input",
    "base.locks",
    "base.renames",
    "base.user_settings",
    "base.graphics",
    "run.pictures",
}


def system_specifics(path: Path) -> Iterator[str]:
    """Yield the modules and calls that only some operating systems have, and the questions which one it is."""
    yield from (name for name in imports(path) if name in SYSTEM_MODULES)
    for node in nodes(path):
        if isinstance(node, ast.Attribute) and ast.unparse(node) in SYSTEM_CALLS | SYSTEM_NAMES:
            yield ast.unparse(node)


def test_what_differs_between_operating_systems_has_one_home() -> None:
    found = {module: set(system_specifics(path)) for module, path in modules() if module not in SYSTEM_HOMES}
    assert {module: used for module, used in found.items() if used} == {}


OPENS_ITSELF = {
    "base.files": "the one that reads",
    "base.writing": "the one that writes",
    "base.locks": "keeps files of ours open",
    "agent.violation_states": "adds lines to a file of its own run",
    "base.descendants": "reads what Linux tells of processes",
    "run.agent_log": "adds to the log of a process",
    "agent.stack_dumps": "the interpreter writes there when it crashes",
    "user_code.call_note": "maps a file of its own run",
}


def opens(path: Path) -> Iterator[str]:
    """Yield the calls that open a file without the checks of ``base/files`` and ``base/writing``."""
    for node in nodes(path):
        match node:
            case ast.Call(func=ast.Attribute(attr="read_text" | "read_bytes" | "write_text" | "write_bytes")):
                yield ast.unparse(node)
            case ast.Call(func=ast.Name(id="open")):
                yield ast.unparse(node)
            case ast.Call(func=ast.Attribute(attr="open"), args=[] | [ast.Constant()]):
                yield ast.unparse(node)
            case ast.Call(func=ast.Attribute(value=ast.Name(id="shutil"), attr="copy" | "copy2" | "copyfile")):
                yield ast.unparse(node)
            case ast.Call(func=ast.Attribute(value=ast.Name(id="ElementTree"), attr="parse")):
                yield ast.unparse(node)
            case _:
                pass


def test_files_are_read_and_written_in_one_place() -> None:
    found = {module: list(opens(path)) for module, path in modules() if module not in OPENS_ITSELF}
    assert {module: calls for module, calls in found.items() if calls} == {}


def test_the_language_server_starts_without_what_plans_and_executes_runs() -> None:
    named = "print(*(name for name in sys.modules if name.startswith('robbdd_tools.')))"
    loaded = loaded_after(f"from robbdd_tools.lsp.handlers import create_server\ncreate_server()\n{named}")
    assert "robbdd_tools.lsp.handlers" in loaded
    later = (
        "campaign",
        "gherkin.preview",
        "graph.write.imported_graphs",
        "run.scheduler",
        "workbench.comparison",
        "workbench.plan",
        "workbench.run",
    )
    assert loaded.isdisjoint(f"robbdd_tools.{name}" for name in later)
