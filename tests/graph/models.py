"""A model with every construct of the language, for tests that must not miss one."""

from kit import EVENTS

EVERYTHING = (
    EVENTS
    + r"""ns other_names = 'https://example.org/other/'
ns bdd = 'https://example.org/taken/'
ns _low = 'https://example.org/low/'
Event (ns=bdd) elsewhere
const set (ns=other_names) mixed { 3, 20 %, -2.5, 1e21, "a \"word\" <&> {x}", 'Gruß', 'two
lines', <places.bench_ws>, 3 }
Predicate (ns=t) <thing> is-put at <place>: ( <thing> is at rest and ( not <thing> is located at <place> ) )
Scenario Template (ns=t) fetch {
    duration: from <start> until <end>
    task: <task>
    var part
    var robot
    var goal
    var speed
    var near
    set var goals
    Given:
        (
            at: holds(<part> is located at <goal>, before <pick-start>)
            and ( held: holds(<part> is held by <robot>, 0.25 seconds before <end>) or "looks \"fine\"" after <start> )
            and ( not ( reach: holds(<robot> can reach <part>, after <start>)
                        and drop: holds(<robot> does not drop <part>, from <start> until <end>) ) )
            and config: holds(<robot> has config speed = <speed>, before <start>)
            and slow: holds(<robot> moves slower than 0.25 m/s whenever <robot> is nearer than <near> to <goal>,
                            before <start>)
            and apart: holds(<part> is farther than 3e-1 m from <robot>, before <start>)
            and put: holds(<part> is-put at <goal>, before <start>)
            and level: holds(<part> is tilted less than 10deg, before <start>)
            and text: holds(pred('{p} & {r}', p=<part>, r=<robot>), 1 seconds after <end>)
        )
    When:
        event <start> occurs
        event <elsewhere> occurs
        Behaviour (ns=other_names) carry {
            duration: from <pick-start> until <place-end>
            <robot> picks <part> and places at <goal>
        }
    Then:
        ( var y exists in <goals> ) such that {
            ( placed: holds(<part> is located at <y>, 2 seconds after <place-end>)
              and clear: holds(<robot> does not collide <y>, from <start> until <end>)
              and guarded: holds(<robot> does not collide <y> whenever <part> is held by <robot>
                                 and <part> is located at <y>,
                                 from <start> until <end>)
              and shown: holds(pred('{p} shines', p=<part>) whenever <part> is located at <y>, from <start> until <end>)
              and soon: holds(<part> is located at <y>, within 1.5 seconds after <place-end>)
              and once: holds(<part> is held by <robot>, at some time from <start> until <end>)
              and lately: holds(<part> is held by <robot>, within 2 seconds before <place-end>) )
        }
}
Scenario Template (ns=t) sort {
    duration: from <start> until <end>
    task: <task>
    set var parts
    set var bins
    var robot
    var wait
    event all-in when <parts> is located at <bins> and <robot> moves slower than 0.1 m/s for <wait> seconds
    event one-in when <parts> is located at <bins>
    for all ( var x in <parts> ) {
        Given: seen: holds(<robot> can reach <x>, before <pick-start>)
        for all ( var b in <places> ) {
            When:
                Behaviour (ns=t) pick { duration: from <pick-start> until <place-end> <robot> picks <x> }
            Then: taken: holds(<x> is held by <robot>, after <place-end>)
        }
    }
    Then:
        sorted: holds(<parts> are sorted into <bins>, after <end>)
        stays: holds(<parts> are sorted into <bins>, <wait> seconds after <end>)
        in-time: holds(<parts> are sorted into <bins>, within <wait> seconds before <end>)
        "calm" <wait> seconds after <end>
        always-calm: holds(<parts> are sorted into <bins>, 1 seconds before every <place-end>)
        calm-once: holds(<parts> are sorted into <bins>, within <wait> seconds after the first <pick-start>)
        calm-at-last: holds(<parts> are sorted into <bins>, after the last <place-end>)
        calm-inside: holds(<parts> are sorted into <bins>, 1 seconds after the first <one-in>)
        fast: holds(it takes less than 12 s, from <start> until <end>)
}
User Story (ns=other_names) zz-first {
    As A "operator" I Want "parts" So That "work goes on"
    Scenarios:
        Scenario table {
            template: <fetch>
            scene: <bench_scene>
            Given: extra: holds(<fetch.robot> can reach <fetch.part>, before <start>)
            When: event <end> occurs
            Then: "free text" after <end>
            variation:
            | <fetch.part> | <fetch.robot> | <fetch.goal> | <fetch.speed> | <fetch.near> | <fetch.goals> |
            |---|
            | <parts.nut> | <arms.ur10> | <places.tray_ws> | 0.1 | 30 cm | ws set <places> |
            | <parts.bolt> | <arms.panda> | <places.bench_ws> | "fast" | 0.3 m |
              { <places.tray_ws>, <places.bench_ws> } |
            | <washers.washer1> | <arms.panda> | <places.bench_ws> | 2 | 250 mm | { } |
        }
        Scenario product {
            template: <sort>
            scene: <bench_scene>
            variation:
                set var <sort.parts>: select 2 repeated combinations from <parts>
                set var <sort.bins>: { { <places.tray_ws> }, { <places.bench_ws>, <places.tray_ws> } }
                var <sort.robot>: { <arms.ur10>, <arms.panda> }
                var <sort.wait>: { 1, 2.5 }
        }
}
User Story (ns=t) aa-second {
    As A "operator" I Want "parts" So That "work goes on"
    Scenarios:
        Scenario chosen {
            template: <sort>
            scene: <bench_scene>
            variation:
                set var <sort.parts>: select 1 permutations from <washers>
                set var <sort.bins>: select 1 combinations from <places>
                var <sort.robot>: agn set <arms>
                var <sort.wait>: { 0.5 }
        }
        Scenario brought {
            template: <fetch>
            scene: <bench_scene>
            variation:
                var <fetch.part>: obj set <washers>
                var <fetch.robot>: agn set <arms>
                var <fetch.goal>: ws set <places>
                var <fetch.speed>: { 1, 1.0, "1" }
                var <fetch.near>: { 30 cm, 0.3 m, -.5e-1 m }
                set var <fetch.goals>: select 2 permutations from <places>
        }
}
"""
)
