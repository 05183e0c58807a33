"""Configurations: names, values, units."""

from __future__ import annotations

import pytest

from robbdd_tools.catalog.settings import DENSE, SETTINGS, Setting, SettingError, setting_of, written


@pytest.mark.parametrize("setting", SETTINGS.values(), ids=lambda setting: setting.name)
def test_every_configuration_says_what_it_is_and_reads_its_own_values(setting: Setting) -> None:
    assert setting.doc
    assert setting.target
    assert setting.low < setting.high
    value = (setting.low, setting.high) * (setting.count // 2) if setting.count > 1 else (float(setting.high),)
    assert setting.read(written(value)) == value
    assert all(setting.read(word) == numbers for word, numbers in setting.words)


def test_the_documented_names_are_known() -> None:
    assert list(SETTINGS) == [
        "approach_speed",
        "attach_distance",
        "belt_speed",
        "carry_clearance",
        "contact_time",
        "displacement_limit",
        "drop_height",
        "ee_speed",
        "exactly_one",
        "follow_speed",
        "force_limit",
        "friction",
        "grip_force",
        "grip_time",
        "height_scale",
        "mass",
        "max_speed",
        "opening",
        "position_ahead",
        "position_left",
        "position_range",
        "release_time",
        "seed",
        "size_scale",
        "travel_height",
        "whole_object",
        "width_scale",
    ]


def test_an_unknown_name_is_told_the_known_ones() -> None:
    with pytest.raises(
        SettingError, match="no configuration 'colour'; the known ones are approach_speed, attach_distance,"
    ):
        setting_of("colour")


def test_a_range_has_a_word_or_four_numbers() -> None:
    assert SETTINGS["position_range"].read("dense") == DENSE
    assert SETTINGS["position_range"].read("0.3 0.5  -0.1 0.2") == (0.3, 0.5, -0.1, 0.2)


@pytest.mark.parametrize(
    ("name", "text", "wanted"),
    [
        ("mass", "heavy", "'mass' cannot be 'heavy': it must be a number from 0.001 to 50 kg"),
        ("mass", "-1", "'mass' cannot be '-1': it must be a number from 0.001 to 50 kg"),
        ("mass", "nan", "it must be a number from 0.001 to 50 kg"),
        ("mass", "1 2", "it must be a number from 0.001 to 50 kg"),
        ("mass", "", "it must be a number from 0.001 to 50 kg"),
        ("seed", "1.5", "it must be a whole number from 0 to 4.29497e"),
        ("ee_speed", "inf", "it must be a number from 0.01 to 3 m/s"),
        ("position_range", "wide", "or normal, or dense"),
        ("position_range", "0.3 0.5", "it must be 4 numbers, each lower bound before its upper one, from -2 to 2 m"),
        ("position_range", "0.5 0.3 -0.1 0.1", "each lower bound before its upper one"),
    ],
)
def test_a_value_of_the_wrong_type_is_told_what_it_can_be(name: str, text: str, wanted: str) -> None:
    with pytest.raises(SettingError) as error:
        SETTINGS[name].read(text)
    assert wanted in str(error.value)


@pytest.mark.parametrize(
    ("name", "text", "numbers"),
    [
        ("ee_speed", "0.2 m/s", (0.2,)),
        ("ee_speed", "0.2m/s", (0.2,)),
        ("travel_height", "30 cm", (0.3,)),
        ("mass", "250 g", (0.25,)),
        ("contact_time", "20 ms", (0.02,)),
        ("height_scale", "80 %", (0.8,)),
        ("position_range", "25 cm 0.6 -400 mm 0.4 m", (0.25, 0.6, -0.4, 0.4)),
    ],
)
def test_numbers_may_have_a_unit(name: str, text: str, numbers: tuple[float, ...]) -> None:
    assert setting_of(name).read(text) == pytest.approx(numbers)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("ee_speed", "0.2 m"),
        ("mass", "1 kg kg"),
        ("mass", "kg 1"),
        ("friction", "0.5 N"),
        ("seed", "3 s"),
        ("mass", "g"),
    ],
)
def test_a_unit_of_another_dimension_is_refused(name: str, text: str) -> None:
    with pytest.raises(SettingError, match=f"'{name}' cannot be '{text}'"):
        setting_of(name).read(text)
