"""The arguments of the commands that run scenarios, and the selection of scenarios that they define."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import uri_to_path
from robbdd_tools.monitor.without_physics import KINEMATIC
from robbdd_tools.syntax.study_content import MOST_SEED

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import SceneInstance
    from robbdd_tools.features.run_verdicts import JudgedScenario
    from robbdd_tools.graph.acceptance_model import AcceptanceModel
    from robbdd_tools.workbench.choice import Choice, Listed
    from robbdd_tools.workbench.plan import Selection
    from robbdd_tools.workbench.rerun import Failed

NO_SCENARIO_FAILED = "no scenario failed"


class BadArgument(RobbddError):
    """The argument of a command does not have its documented form."""


class BadSetting(RobbddError):
    """A setting of the client cannot be used."""


@dataclass(frozen=True, slots=True)
class RunDefaults:
    """The client's settings for runs of a document.

    - ``bhv``: maps implementations of behaviours to the catalog behaviours to execute instead.
    - ``scenex``: the paths of ``.scenex`` files for scenarios without an execution.
    """

    bhv: Mapping[str, str] = field(default_factory=dict[str, str])
    scenex: Sequence[Path] = ()


@dataclass(frozen=True, slots=True)
class RunOptions:
    """The options of a client for a run. All but ``uri`` are optional.

    - ``scenario``: a variant or an execution, by local name, CURIE or IRI.
    - ``variation``: the number of one scenario in its variant.
    - ``only``: a list of scenarios. Each entry has a ``variant`` (IRI) and, optionally, the numbers of scenarios
      (``variations``) and one ``execution`` (IRI).
    - ``failed``: select the scenarios that did not hold in their last run.
    - ``where``, ``first``, ``sample``, ``pairwise``, ``seed``, ``repeat`` and ``jobs``: as for ``robbdd run``.
    - ``scenex``: the path of a ``.scenex``, absolute or from the folder of the model.
    - ``stop_on_failure``: execute nothing more after the first failure.
    - ``debug``: execute all scenarios in one process without a time limit. The process waits for a debugger and
      announces this by the message ``DebuggerAwaited``.
    - ``record``: render a picture of each violation.
    - ``token``: the name of the run in the messages about it.
    """

    uri: str
    scenario: str | None = None
    variation: int | None = None
    only: Sequence[Mapping[str, Any]] | None = None
    token: str | None = None
    failed: bool = False
    record: bool = False
    where: str | None = None
    first: int | None = None
    sample: int | None = None
    pairwise: int | None = None
    seed: int | None = None
    repeat: int | None = None
    jobs: int | None = None
    bhv: Mapping[str, str] = field(default_factory=dict[str, str])
    scenex: str | None = None
    stop_on_failure: bool = False
    debug: bool = False

    @classmethod
    def of(cls, argument: Mapping[str, Any]) -> RunOptions:
        """Return the options in the argument of a command. Raises ``BadArgument``."""
        known = {name: argument[name] for name in cls.__slots__ if argument.get(name) is not None}
        known.setdefault("scenario", argument.get("variant"))
        for name, (fits, form) in _FORMS.items():
            if known.get(name) is not None and not fits(known[name]):
                raise BadArgument(f"the command's argument has no usable '{name}': it must be {form}")
        if "uri" not in known:
            raise BadArgument("the command's argument has no usable 'uri'")
        reducing = [name for name in ("first", "sample", "pairwise") if name in known]
        if len(reducing) > 1:
            raise BadArgument(f"give only one of {' and '.join(reducing)}")
        return cls(**known)

    @property
    def is_whole(self) -> bool:
        """Whether all scenarios of the selected variants run.

        In this case, other stored results of these variants are obsolete.
        """
        numbers = {self.variation, self.where, self.first, self.sample, self.pairwise}
        parts = (entry.get("variations") for entry in self.only or ())
        return (
            not self.failed and not self.stop_on_failure and numbers == {None} and all(part is None for part in parts)
        )


def select(
    options: RunOptions,
    model: AcceptanceModel,
    results: Iterable[JudgedScenario],
    defaults: RunDefaults | None = None,
) -> tuple[Selection, int | None]:
    """Return the selection for a model, and the number of repetitions (``None`` for the number that the model states).

    ``results`` are the results of earlier runs. Raises ``NothingFailed`` and, for a ``scenex`` that cannot be
    used, ``NotAModel``, ``ModelErrors`` or ``SceneChoiceError``, or ``BadSetting`` if a setting names it.
    """
    from robbdd_tools.workbench.choice import Choice, Listed
    from robbdd_tools.workbench.model import read_instances
    from robbdd_tools.workbench.plan import Selection

    variants = [variant.iri for story in model.stories for variant in story.variants]
    names = () if options.scenario is None else (options.scenario,)
    seed, repeat = options.seed, options.repeat
    choices: list[Choice] = []
    defaults = defaults or RunDefaults()
    substitutions = defaults.bhv
    scenex: tuple[Path, ...] = ()
    world = ""
    if options.only is not None:
        choices.append(Choice(map(_listed, options.only)))
    if options.variation is not None:
        choices.append(Choice(Listed(iri, frozenset({options.variation})) for iri in variants))
    if options.failed:
        failed = _failed([one for one in results if one.variant in variants and one.outcome != "holds"])
        choices.append(failed.choice)
        seed = failed.seed if seed is None else seed
        repeat = repeat or failed.repeat
        substitutions = {**substitutions, **failed.substitutions}
        scenex, world = failed.scenex, failed.world
    if options.scenex is not None:
        scenex = ((uri_to_path(options.uri) or Path()).parent / options.scenex,)
    instances = read_instances(scenex) if scenex else _instances_of(defaults)
    selection = Selection(
        names,
        options.where,
        options.first,
        options.sample,
        options.pairwise,
        seed,
        choices=tuple(choices),
        substitutions=options.bhv,
        default_substitutions=substitutions,
        instances=() if options.scenex is None else instances,
        default_instances=instances,
        world=world,
    )
    return selection, repeat


def _instances_of(defaults: RunDefaults) -> tuple[SceneInstance, ...]:
    from robbdd_tools.workbench.model import ModelErrors, read_instances

    try:
        return read_instances(defaults.scenex)
    except RobbddError as error:
        first = error.findings[0] if isinstance(error, ModelErrors) else error
        raise BadSetting(f"the setting 'robbdd.run.scenex' cannot be used: {first}") from None


def _failed(failed: Sequence[JudgedScenario]) -> Failed:
    """Return the selection that executes failed scenarios again, with the seed of their latest run."""
    from robbdd_tools.workbench.choice import Choice, Listed
    from robbdd_tools.workbench.rerun import Failed, NothingFailed

    if not failed:
        raise NothingFailed(NO_SCENARIO_FAILED)
    listed = [
        Listed(one.variant, frozenset({one.variation}), one.execution or None, frozenset({one.repetition}))
        for one in failed
    ]
    newest = max(failed, key=lambda one: one.run)
    repeated = max(one.repetition for one in failed)
    substituted = (one.substitution for one in failed if one.substitution is not None)
    substitutions = {one.implementation: one.executed for one in substituted}
    chosen = (Path(one.scene_instance.file) for one in failed if one.scene_instance is not None)
    repeat = repeated if repeated > 1 else None
    return Failed(
        Choice(listed),
        newest.seed,
        repeat,
        substitutions=substitutions,
        scenex=tuple(dict.fromkeys(chosen)),
        world=KINEMATIC if newest.world else "",
    )


def _listed(entry: Mapping[str, Any]) -> Listed:
    from robbdd_tools.workbench.choice import Listed

    numbers = entry.get("variations")
    return Listed(str(entry["variant"]), None if numbers is None else frozenset(numbers), entry.get("execution"))


def _is_text(value: object) -> bool:
    return isinstance(value, str)


def _is_flag(value: object) -> bool:
    return isinstance(value, bool)


def _is_number(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _is_seed(value: object) -> bool:
    return isinstance(value, int) and _is_number(value) and abs(value) <= MOST_SEED


def _is_positive(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value > 0


def _is_strength(value: object) -> bool:
    return _is_number(value) and value in (2, 3)


def _is_choice(value: object) -> bool:
    return isinstance(value, list) and all(map(_is_entry, cast("list[object]", value)))


def _is_entry(value: object) -> bool:
    if not isinstance(value, Mapping):
        return False
    entry = cast("Mapping[str, object]", value)
    numbers, execution = entry.get("variations", []), entry.get("execution", "")
    are_numbers = isinstance(numbers, list) and all(map(_is_number, cast("list[object]", numbers)))
    return _is_text(entry.get("variant")) and (numbers is None or are_numbers) and isinstance(execution, str | None)


def _is_substitution(value: object) -> bool:
    return isinstance(value, Mapping) and all(map(_is_text, cast("Mapping[object, object]", value).values()))


_FORMS: Mapping[str, tuple[Callable[[object], bool], str]] = {
    **dict.fromkeys(("uri", "scenario", "where", "token", "scenex"), (_is_text, "a text")),
    **dict.fromkeys(("failed", "record", "stop_on_failure", "debug"), (_is_flag, "true or false")),
    **dict.fromkeys(("first", "sample", "repeat", "jobs"), (_is_positive, "a whole number above 0")),
    "variation": (_is_number, "a whole number"),
    "seed": (_is_seed, f"a whole number from -{MOST_SEED} to {MOST_SEED}"),
    "pairwise": (_is_strength, "2 or 3"),
    "bhv": (_is_substitution, "an object of behaviour implementations and catalog behaviours"),
    "only": (_is_choice, "a list of objects with a 'variant' and, if wanted, 'variations' and an 'execution'"),
}
