"""A target has a configuration value."""

from robbdd_tools.catalog.api import Kind, Predicate, Slot

HAS_CONFIG = Predicate(
    name="has-config",
    phrase="<target> has config $name = <value>",
    rdf_type="bdd:HasConfigPredicate",
    slots=(
        Slot("target", Kind.ANY, "bdd:config-target"),
        Slot("name", Kind.NAME, "bdd:config-name"),
        Slot("value", Kind.VALUE, "bdd:config-variable"),
    ),
    sentence='"{target}" has config "{name}" = "{value}"',
    unit="",
    doc="The target was set up with this value of the named configuration.",
)
