"""Generated models of any length, in which every line is of a kind that users write."""

from __future__ import annotations

HEAD = """import "lab.scene"
ns t = 'https://example.org/bench/'
Task (ns=t) task
Event (ns=t) start
Event (ns=t) pick-start
Event (ns=t) place-end
Event (ns=t) end
"""

BLOCK = """Scenario Template (ns=t) fetch{n} {{
    duration: from <start> until <end>
    task: <task>
    var part{n}
    var robot{n}
    var goal{n}
    Given:
        on-bench{n}: holds(<part{n}> is located at <goal{n}>, before <pick-start>)
    When:
        Behaviour (ns=t) carry{n} {{
            duration: from <pick-start> until <place-end>
            <robot{n}> picks <part{n}> and places at <goal{n}>
        }}
    Then:
        (
            in-tray{n}: holds(<part{n}> is located at <goal{n}>, 0.5 seconds after <place-end>)
            and
            safe{n}: holds(<robot{n}> does not collide <goal{n}>, from <pick-start> until <place-end>)
        )
}}
User Story (ns=t) fetching{n} {{
    As A "operator"
    I Want "parts fetched"
    So That "work goes on"
    Scenarios:
        Scenario bench-to-tray{n} {{
            template: <fetch{n}>
            scene: <bench_scene>
            variation:
                var <fetch{n}.part{n}>: obj set <parts>
                var <fetch{n}.robot{n}>: {{ <arms.panda> }}
                var <fetch{n}.goal{n}>: {{ <places.bench_ws>, <places.tray_ws> }}
        }}
}}
"""


STORY = BLOCK.index("User Story")
SCENARIO = BLOCK[BLOCK.index("        Scenario bench") : BLOCK.rindex("}}")]


def long_story(lines: int) -> str:
    """Return a sound model with a single user story that alone has about that many lines."""
    scenario = SCENARIO.replace("tray{n}", "tray{n}-{number}")
    count = lines // scenario.count("\n")
    scenarios = "".join(scenario.format(n=1, number=number) for number in range(count))
    template, story = BLOCK[:STORY].format(n=1), BLOCK[STORY:].format(n=1)
    return HEAD + template + story.replace(SCENARIO.format(n=1), scenarios)


def model(lines: int) -> str:
    """Return a sound model of at least ``lines`` lines, less than one block longer."""
    blocks: list[str] = [HEAD]
    written = HEAD.count("\n")
    while written < lines:
        blocks.append(BLOCK.format(n=len(blocks)))
        written += blocks[-1].count("\n")
    return "".join(blocks)
