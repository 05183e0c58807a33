"""Arguments of ``robbdd judge`` for logs. Heavy modules are imported only when an argument is used."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.commands.judge import JudgeOptions

QUIET = 10.0
"""A followed recording counts as ended after this many seconds without a new record."""


def allow_log(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that only a log needs."""
    log = parser.add_argument_group("logs")
    text = "the scenario or execution that the robot executed; repeats"
    log.add_argument("--scenario", metavar="NAME", action="append", help=text)
    text = "the values with which the robot executed it: 'robot=panda and target=cube1'"
    log.add_argument("--where", metavar="EXPRESSION", help=text)
    text = "judge scenarios without an execution by the models and places in this .scenex for their scene; repeats"
    log.add_argument("--scenex", metavar="FILE", type=Path, action="append", help=text)
    text = "the frame of an element in the log (default: the frame of its name); repeats"
    log.add_argument("--frame", metavar="ELEMENT=FRAME", type=_pair, action="append", help=text)
    text = "the frame of the base of an arm's model (default: the driver's usual name, or the .scenex); repeats"
    log.add_argument("--base", metavar="AGENT=FRAME", type=_pair, action="append", help=text)
    text = "the topic of an arm's joint states (default: by the name of the agent); repeats"
    log.add_argument("--joints", metavar="AGENT=TOPIC", type=_pair, action="append", help=text)
    text = "the name of a joint in the log (default: that of the model, with a prefix or suffix); repeats"
    log.add_argument("--joint", metavar="[AGENT/]JOINT=NAME", type=_pair, action="append", help=text)
    text = "the title of a table's column (time, frame, x, y, z, qw, qx, qy, qz, parent, event); repeats"
    log.add_argument("--column", metavar="NAME=TITLE", type=_pair, action="append", help=text)
    text = "a signal that the agent holds something: 'ur10=/vacuum', 'ur10/cube1=joint finger above 5 mm'; repeats"
    log.add_argument("--grip", metavar="AGENT[/OBJECT]=SIGNAL", type=_grip, action="append", help=text)
    text = "by how many seconds the clock of the headers on a topic of a ROS bag is ahead; repeats"
    log.add_argument("--clock", metavar="TOPIC=SECONDS", type=_clock, action="append", help=text)
    text = "messages that report an event: 'evt-pick-end=/gripper/closed becomes true'; repeats"
    log.add_argument("--event", metavar="EVENT=SIGNAL", type=_event, action="append", help=text)
    text = "start of the period that is judged, in seconds since the start of the log"
    log.add_argument("--from", dest="begin", metavar="SECONDS", type=_moment, help=text)
    log.add_argument("--until", dest="end", metavar="SECONDS", type=_moment, help="end of the period that is judged")
    text = "the log is still recorded: judge each clause when its window has closed, until nothing was written for this"
    text += f" time (default: {QUIET:g} s)"
    log.add_argument("--follow", metavar="SECONDS", type=_positive, nargs="?", const=QUIET, help=text)
    log.add_argument("--world", metavar="FRAME", help="the frame of the world (default: the root of the frames)")
    text = "a table (CSV) of events that the log does not contain: time (s since the begin of the log), event"
    log.add_argument("--events", metavar="FILE.csv", type=Path, help=text)
    text = "largest time between two observations that are interpolated, in seconds (default: 0.5)"
    log.add_argument("--max-gap", metavar="SECONDS", type=_positive, default=0.5, help=text)
    text = "largest number of samples per second (default: 200)"
    log.add_argument("--rate", metavar="HZ", type=_positive, default=200.0, help=text)
    text = "largest error of the positions: '3 mm', 'cube1=5 mm'; of angles: '2 deg'; of speeds: '0.05 m/s'; repeats"
    log.add_argument("--uncertainty", metavar="[ELEMENT=]QUANTITY", type=_uncertainty, action="append", help=text)
    log.add_argument("--no-store", action="store_true", help="do not store the result")


def judge_options(options: argparse.Namespace) -> JudgeOptions:
    """Return the options of the parsed arguments."""
    from robbdd_tools.commands.judge import JudgeOptions
    from robbdd_tools.workbench.log_judging import LogNames
    from robbdd_tools.workbench.plan import Selection

    frames: dict[str, str] = dict(options.frame or ())
    errors: dict[str, float] = dict(options.uncertainty or ())
    clocks: dict[str, float] = dict(options.clock or ())
    names = LogNames(
        frames,
        options.world or "",
        options.max_gap,
        options.rate,
        options.events,
        errors,
        dict(options.base or ()),
        dict(options.joints or ()),
        dict(options.joint or ()),
        dict(options.column or ()),
        tuple(options.grip or ()),
        clocks,
        tuple(options.event or ()),
        options.begin,
        options.end,
        options.follow,
    )
    selection = Selection(options.scenario or (), options.where)
    # A single argument is a model, whose executions name logs.
    run, paths = (options.run, (options.path, *options.more)) if options.path else ("", (Path(options.run),))
    keep, scenex = not options.no_store, tuple(options.scenex or ())
    return JudgeOptions(run, paths, options.store, options.json, selection, names, keep, scenex)


def _pair(text: str) -> tuple[str, str]:
    name, separator, value = text.partition("=")
    if not (name and separator and value):
        raise argparse.ArgumentTypeError(f"'{text}' must be NAME=VALUE, for example cube1=camera/cube")
    return name, value


def _clock(text: str) -> tuple[str, float]:
    topic, written = _pair(text)
    try:
        seconds = float(written)
    except ValueError:
        seconds = float("inf")
    if not abs(seconds) < float("inf"):
        raise argparse.ArgumentTypeError(f"'{text}' must be TOPIC=SECONDS, for example /camera/pose=0.12")
    return topic, seconds


def _grip(text: str) -> str:
    from robbdd_tools.protocol.grip_signals import read_grip_signal

    try:
        read_grip_signal(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    return text


def _event(text: str) -> str:
    from robbdd_tools.protocol.event_signals import read_event_signal

    try:
        read_event_signal(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    return text


def _moment(text: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = -1.0
    if not 0 <= seconds < float("inf"):
        raise argparse.ArgumentTypeError(f"'{text}' must be a time in seconds since the begin of the log")
    return seconds


def _uncertainty(text: str) -> tuple[str, float]:
    from robbdd_tools.workbench.log_uncertainty import read_uncertainty

    try:
        return read_uncertainty(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _positive(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not 0 < number < float("inf"):
        raise argparse.ArgumentTypeError(f"'{text}' must be a number above 0")
    return number
