"""A debug adapter: it answers one editor's requests and forwards the messages of one debugged execution."""

from __future__ import annotations

import json
import tempfile
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from queue import SimpleQueue
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import load_text, path_to_uri
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.dap.conditions import FILTERS
from robbdd_tools.dap.launch_arguments import debug_request
from robbdd_tools.dap.run_output import output_of
from robbdd_tools.dap.session_state import Breakpoints, VariableHandles, source_path
from robbdd_tools.dap.stack import stack_frames
from robbdd_tools.dap.variables import UnknownName, Variable, evaluate, scopes_of
from robbdd_tools.dap.wire import BrokenMessage, Wire
from robbdd_tools.protocol.messages import DebuggerAwaited, RunMessage
from robbdd_tools.protocol.pauses import Pause, Paused, Reason, Resume, SceneWritten, SetBreakpoints, Until, WriteScene
from robbdd_tools.protocol.run_folder import DEBUG_HOST
from robbdd_tools.run.store import RESULTS
from robbdd_tools.workbench.clause_debugging import DebuggedScenario, scene_document

if TYPE_CHECKING:
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.workbench.run import Run

THREAD = 1
CAPABILITIES: dict[str, Any] = {
    "supportsConfigurationDoneRequest": True,
    "supportsConditionalBreakpoints": True,
    "supportsEvaluateForHovers": True,
    "supportsTerminateRequest": True,
    "supportTerminateDebuggee": True,
    "supportsBreakpointLocationsRequest": True,
    "exceptionBreakpointFilters": FILTERS,
}
STOPPED = {Reason.ENTRY: "entry", Reason.STEP: "step", Reason.PAUSE: "pause", Reason.BREAKPOINT: "breakpoint"}


class Refused(RobbddError):
    """A request cannot be answered now; the message gives the reason."""


class DebugAdapter:
    """The adapter of one session. ``serve`` returns when the editor has disconnected. It leaves nothing running."""

    def __init__(self, wire: Wire) -> None:
        self._wire = wire
        self._events: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self._client: Mapping[str, Any] = {}
        self._scenario: DebuggedScenario | None = None
        self._breakpoints: Breakpoints | None = None
        self._stops_on_entry = self._is_plain = False
        self._run: Run | None = None
        self._consumer: threading.Thread | None = None
        self._paused: Paused | None = None
        self._handles = VariableHandles()
        self._scenes: list[tuple[Mapping[str, Any], Path]] = []
        self._folder = tempfile.TemporaryDirectory(prefix="robbdd-dap-")
        self._requests: dict[str, Callable[[Mapping[str, Any]], Any]] = {
            "initialize": self._initialize,
            "launch": self._launch,
            "setBreakpoints": self._set_breakpoints,
            "setExceptionBreakpoints": self._set_exception_breakpoints,
            "breakpointLocations": self._breakpoint_locations,
            "configurationDone": self._configuration_done,
            "threads": lambda _: {"threads": [{"id": THREAD, "name": self._title}]},
            "stackTrace": self._stack_trace,
            "scopes": self._scopes,
            "variables": self._variables,
            "evaluate": self._evaluate,
            "continue": lambda _: self._resume(Until.BREAKPOINT, {"allThreadsContinued": True}),
            "next": lambda _: self._resume(Until.MOMENT),
            "stepIn": lambda _: self._resume(Until.SAMPLE),
            "stepOut": lambda _: self._resume(Until.CLOSED),
            "pause": self._pause,
            "terminate": self._terminate,
        }

    def serve(self) -> None:
        """Answer requests until the editor disconnects or its connection ends."""
        threading.Thread(target=self._read, daemon=True).start()
        try:
            while (event := self._events.get()) is not None:
                event()
        finally:
            if self._run is not None:
                self._run.cancel("the debugger was disconnected")
            if self._consumer is not None:
                self._consumer.join()
            self._folder.cleanup()

    def _read(self) -> None:
        try:
            for message in self._wire.messages():
                if message.get("type") == "request":
                    self._events.put(lambda request=message: self._answer(request))
                if message.get("command") == "disconnect":
                    break
        except BrokenMessage as error:
            self._output(str(error), "stderr")
        self._events.put(None)

    def _answer(self, request: Mapping[str, Any]) -> None:
        command = str(request.get("command"))
        arguments: Any = request.get("arguments") or {}
        try:
            if command == "disconnect":
                body = None
            elif command == "robbdd/scene":
                self._write_scene(request)
                return
            elif command not in self._requests:
                raise Refused(f"the request '{command}' is not supported")
            else:
                body = self._requests[command](arguments)
        except (RobbddError, UnknownName, OSError) as error:
            self._respond(request, problem=str(error), shown=command in ("launch", "configurationDone"))
            return
        self._respond(request, body)
        if command == "launch":
            self._event("initialized")

    def _respond(self, request: Mapping[str, Any], body: Any = None, problem: str = "", shown: bool = False) -> None:
        fields: dict[str, Any] = {"request_seq": request.get("seq", 0), "command": str(request.get("command"))}
        if problem:
            error = {"id": 1, "format": "{reason}", "variables": {"reason": problem}, "showUser": shown}
            self._wire.write("response", success=False, message=problem, body={"error": error}, **fields)
        else:
            self._wire.write("response", success=True, **fields, **({} if body is None else {"body": body}))

    def _event(self, event: str, **body: Any) -> None:
        self._wire.write("event", event=event, body=body)

    def _output(self, text: str, category: str = "console", **more: Any) -> None:
        self._event("output", category=category, output=text + "\n", **more)

    def _initialize(self, arguments: Mapping[str, Any]) -> Any:
        self._client = arguments
        return CAPABILITIES

    def _launch(self, arguments: Mapping[str, Any]) -> None:
        if self._scenario is not None:
            raise Refused("a scenario is being debugged already")
        request = debug_request(arguments)
        scenario = DebuggedScenario(request)
        self._stops_on_entry, self._is_plain = bool(arguments.get("stopOnEntry")), bool(arguments.get("noDebug"))
        self._breakpoints = Breakpoints(scenario)
        self._scenario = scenario
        if scenario.selected > 1:
            choose = 'choose another one by "scenario", "where" or "variation"'
            self._output(f"{self._title}: the first of {scenario.selected} selected executions; {choose}")

    @property
    def _title(self) -> str:
        return "Simulation" if self._scenario is None else self._scenario.spec.name.rpartition(":")[2]

    def _set_breakpoints(self, arguments: Mapping[str, Any]) -> Any:
        stated = arguments.get("breakpoints") or [{"line": line} for line in arguments.get("lines") or ()]
        if self._breakpoints is None:
            nothing = {"verified": False, "message": "no scenario is debugged yet"}
            return {"breakpoints": [nothing for _ in stated]}
        lines = [(int(one["line"]) + self._first_line, one.get("condition")) for one in stated]
        answers = self._breakpoints.set_in(source_path(arguments["source"]), lines)
        self._send_breakpoints()
        return {"breakpoints": [{**one, "line": one["line"] - self._first_line} for one in answers]}

    def _set_exception_breakpoints(self, arguments: Mapping[str, Any]) -> None:
        if self._breakpoints is not None:
            self._breakpoints.set_everywhere(arguments.get("filters") or ())
            self._send_breakpoints()

    def _breakpoint_locations(self, arguments: Mapping[str, Any]) -> Any:
        first = int(arguments["line"]) + self._first_line
        last = int(arguments.get("endLine", arguments["line"])) + self._first_line
        lines = [] if self._scenario is None else self._scenario.clause_lines(source_path(arguments["source"]))
        return {"breakpoints": [{"line": line - self._first_line} for line in lines if first <= line <= last]}

    @property
    def _first_line(self) -> int:
        """The number to add to a client's line so that lines count from 1."""
        return 0 if self._client.get("linesStartAt1", True) else 1

    def _configuration_done(self, _: Mapping[str, Any]) -> None:
        scenario = self._launched()
        self._run = run = scenario.begin()
        self._event("process", name=self._title, isLocalProcess=True, startMethod="launch")
        self._consumer = threading.Thread(target=self._consume, args=(run,), daemon=True)
        self._consumer.start()

    def _consume(self, run: Run) -> None:
        """Forward the messages of the run, in the thread that executes it."""
        with run:
            for message in run.messages():
                self._events.put(lambda message=message: self._take(run, message))
        self._events.put(lambda: self._conclude(run))

    def _take(self, run: Run, message: RunMessage) -> None:
        match message:
            case Paused():
                self._pause_at(run, message)
            case SceneWritten():
                self._show_scene(run, message)
            case DebuggerAwaited(port):
                self._attach_python(port)
            case _:
                for text, category in output_of(message, run.manifest.scenarios[0]):
                    self._output(text, category)

    def _conclude(self, run: Run) -> None:
        self._paused = None
        for problem in filter(None, (run.problem, run.ending)):
            self._output(problem, "stderr")
        kept = f"kept as run {run.number}" if run.number else ""
        counts = [str(one.verdict) for one in run.progress.scenarios]
        self._output("; ".join(filter(None, (f"{self._title}: {', '.join(counts)}", kept))))
        if run.number:
            self._event("robbdd/stored", results=path_to_uri(run.folder / RESULTS))
        self._event("exited", exitCode=0 if counts == ["holds"] else 1)
        self._event("terminated")

    def _pause_at(self, run: Run, paused: Paused) -> None:
        if paused.reason == Reason.ENTRY:
            self._send_breakpoints()
            if not self._stops_on_entry or self._is_plain:
                run.order(Resume())
                return
        self._paused = paused
        self._handles.clear()
        spec = self._spec
        assert self._breakpoints is not None
        names = {clause.line: self._launched().title(clause) for clause in spec.clauses}
        text = ", ".join(f"{names[hit.line]} {hit.moment}" for hit in paused.hits)
        body: dict[str, Any] = {"reason": STOPPED[Reason(paused.reason)], "threadId": THREAD, "allThreadsStopped": True}
        if paused.hits:
            body |= {"description": f"{text} at {paused.time:.3f} s", "text": text}
            self._output(f"{paused.time:.3f} s: {text}")
        # Filters usually have the reason "exception", but it would announce an error in code.
        self._event("stopped", **body, hitBreakpointIds=self._breakpoints.hit(spec, paused.hits))

    def _launched(self) -> DebuggedScenario:
        if self._scenario is None:
            raise Refused("no scenario is debugged yet: launch one")
        return self._scenario

    @property
    def _spec(self) -> ScenarioSpec:
        """The executed scenario, with the lines of its feature. Raises ``Refused``."""
        return self._launched().spec if self._run is None else self._run.manifest.scenarios[0]

    @property
    def _state(self) -> Paused:
        if self._paused is None:
            raise Refused("the simulation is running: pause it first")
        return self._paused

    def _stack_trace(self, _: Mapping[str, Any]) -> Any:
        frames = stack_frames(self._launched(), self._spec, self._state, self._first_line)
        return {"stackFrames": frames, "totalFrames": len(frames)}

    def _scopes(self, arguments: Mapping[str, Any]) -> Any:
        paused = self._state
        line = paused.line if arguments.get("frameId") == 0 else None
        scopes = scopes_of(paused, self._spec, line)
        return {
            "scopes": [
                {"name": one.name, "variablesReference": self._handles.of(one.inner), "expensive": False}
                for one in scopes
            ]
        }

    def _variables(self, arguments: Mapping[str, Any]) -> Any:
        return {"variables": [self._shown(one) for one in self._handles.variables(arguments["variablesReference"])]}

    def _shown(self, variable: Variable) -> dict[str, Any]:
        reference = self._handles.of(variable.inner)
        return {"name": variable.name, "value": variable.value, "variablesReference": reference}

    def _evaluate(self, arguments: Mapping[str, Any]) -> Any:
        found = self._shown(evaluate(str(arguments.get("expression", "")), self._state, self._spec))
        return {"result": found["value"], "variablesReference": found["variablesReference"]}

    def _resume(self, until: Until, body: Any = None) -> Any:
        _ = self._state
        self._paused = None
        assert self._run is not None
        self._run.order(Resume(until))
        return body

    def _pause(self, _: Mapping[str, Any]) -> None:
        if self._run is not None and self._paused is None:
            self._run.order(Pause())

    def _terminate(self, _: Mapping[str, Any]) -> None:
        if self._run is not None:
            self._run.cancel("the debugger ended the execution")

    def _send_breakpoints(self) -> None:
        if self._run is not None and self._breakpoints is not None:
            order = SetBreakpoints() if self._is_plain else self._breakpoints.order(self._spec)
            self._run.order(order)

    def _attach_python(self, port: int) -> None:
        """Ask the editor to attach a debugger of Python code. The process waits for it."""
        if self._client.get("supportsStartDebuggingRequest"):
            name = f"{self._title} (Python)"
            configuration = {"type": "robbdd", "request": "attach", "name": name, "port": port, "justMyCode": True}
            arguments = {"request": "attach", "configuration": configuration}
            self._wire.write("request", command="startDebugging", arguments=arguments)
        else:
            self._output(f"waiting for a debugger of Python code at {DEBUG_HOST}:{port}")

    def _write_scene(self, request: Mapping[str, Any]) -> None:
        """Order the process to write the execution so far. ``_show_scene`` answers the editor's request."""
        _ = self._state
        assert self._run is not None
        path = Path(self._folder.name, f"{request.get('seq')}.json")
        self._scenes.append((request, path))
        self._run.order(WriteScene(str(path)))

    def _show_scene(self, run: Run, message: SceneWritten) -> None:
        request, path = self._scenes.pop(0)
        if message.problem:
            self._respond(request, problem=message.problem)
            return
        try:
            written = json.loads(load_text(path, RESULT_SIZE))
        except (OSError, ValueError) as error:
            self._respond(request, problem=str(error))
            return
        line = None if self._paused is None else self._paused.line
        self._respond(request, scene_document(run, written, line))
        path.unlink(missing_ok=True)
