"""Signals that are named in other European languages, in any encoding, are what they mean."""

import tomllib
import unicodedata
from pathlib import Path

import numpy as np
import pytest

from boatsim.recordings.importing.convert import convert_log
from boatsim.recordings.importing.foreign_words import MEANINGS, english_unit, plain_name
from boatsim.recordings.importing.log import Log, Signal
from boatsim.recordings.importing.mapping import parse_map
from boatsim.recordings.importing.mapping_proposal import propose_map
from boatsim.recordings.importing.signal_classification import classify_signal
from boatsim.recordings.importing.signal_words import tokenize_name
from boatsim.recordings.logs.table import read
from tests.recordings.importing.test_owners_tables import check_motion, columns_of_run
from tests.recordings.importing.test_proposal_by_motion import DOF, DRIVES, SPEED_AT_80

T = np.linspace(0.0, 60.0, 600)
# name, lowest and highest value, unit of the format, column, unit of the expression
NAMES = """
Kurs|0|359||psi_rad|deg
Steuerkurs [°]|0|359|°|psi_rad|deg
Kurs über Grund|0|359|°|nothing|
KüG|0|359|°|nothing|
cap|0|359||psi_rad|deg
Cap compas (degrés)|0|359|degrés|psi_rad|deg
Cap fond|0|359||nothing|
rumbo|0|359||psi_rad|deg
rumbo sobre el fondo|0|359||nothing|
koers|0|359||psi_rad|deg
battery_cap|0|100||nothing|
Windrichtung|0|359|°|nothing|
Direction du vent|0|359|°|nothing|
Geschwindigkeit|0|9|kn|nothing|
Fahrt über Grund|0|9|kn|nothing|
Längsgeschwindigkeit|0|9|m/s|u_mps|
Vitesse longitudinale|0|9||u_mps|
Quergeschwindigkeit|-1|1||v_mps|
Drehrate|-9|9|°/s|r_radps|degps
Drehrate [Grad/min]|-99|99|Grad/min|r_radps|degpmin
gierrate_grad_s|-9|9||r_radps|degps
Vitesse de rotation|-9|9|°/s|r_radps|degps
vitesse de lacet|-9|9|°/s|r_radps|degps
taux de virage|-9|9|°/s|r_radps|degps
velocidad de giro|-9|9|°/s|r_radps|degps
svinghastighet|-9|9|°/s|r_radps|degps
Ruderwinkel|-30|30||command|deg
Ruderlage Ist|-30|30|°|actual|deg
angle de barre|-30|30||command|deg
barre|-30|30||command|deg
timón|-30|30||command|deg
rorvinkel|-30|30||command|deg
roerhoek|-30|30||command|deg
Drehzahl Bb [U/min]|0|900|U/min|command|rpm
Motordrehzahl Steuerbord|0|900|1/min|command|rpm
Régime moteur bâbord|0|900|tr/min|command|rpm
toerental stuurboord|0|900|rpm|command|rpm
turtall babord|0|900|omdr/min|command|rpm
Gashebel [%]|0|100|%|command|percent
Sollkurs|0|359|°|nothing|
Breite|54|55||latitude|deg
Geogr. Länge|10|11||longitude|deg
Laengengrad|10|11||longitude|deg
Langengrad|10|11||longitude|deg
latitud|54|55||latitude|deg
lengdegrad|10|11||longitude|deg
Tiefe|3|9|m|nothing|
Profondeur|3|9|m|nothing|
Krängung|-9|9|°|phi_rad|deg
gîte|-9|9|°|phi_rad|deg
Nickwinkel|-9|9|°|theta_rad|deg
Hochwert|5000|5100|m|x_m|
Rechtswert|400|500|m|y_m|
rotation_rate_x|-9|9||nothing|
x_est|0|9||x_m|
"""


@pytest.mark.parametrize("line", NAMES.strip().splitlines(), ids=lambda line: line.split("|")[0])
def test_a_foreign_name_is_classified_as_its_english_one(line):
    name, low, high, unit, column, word = line.split("|")
    signal = Signal(T, np.linspace(float(low), float(high), len(T)), unit)
    found = classify_signal(name, signal, Log(Path("log"), {}))
    assert (found.column if found else "nothing") == column
    assert (found.word if found else "") == word


@pytest.mark.parametrize(
    "name",
    [
        "Länge",
        "LÄNGE",
        "Laenge",
        "L\x84nge",
        "L\x8ange",
        "LÃ¤nge",
        "LÃƒÂ¤nge",
        "L\ufffdnge",
        "L?nge",
    ],
)
def test_an_umlaut_is_one_letter_in_every_encoding(name):
    assert tokenize_name(name) == ["longitude"]
    assert tokenize_name(unicodedata.normalize("NFD", name)) == ["longitude"]


@pytest.mark.parametrize("unit", ["°", "Grad", "grados", "degrés", "Â°", "\xf8", "\xa1"])
def test_a_degree_sign_is_one_in_every_encoding(unit):
    assert english_unit(unit) == "deg" or plain_name(unit) == "°"


def test_every_word_has_one_meaning():
    seen = {}
    for english, words in MEANINGS.items():
        for word in words.split():
            assert seen.setdefault(word, english) == english, word


@pytest.mark.parametrize(
    "name", ["current_fuel_capacity", "lat?long", "ATT.DesYaw", "/imu/data[2].x", "RoT", "port?"]
)
def test_english_names_keep_their_words(name):
    assert "heading" not in tokenize_name(name)
    assert len(tokenize_name(name)) == len([w for w in tokenize_name(name) if w in name.lower()])


def test_a_word_for_heading_and_course_is_left_to_the_owner():
    signals = {"Kurs": Signal(T, np.linspace(0.0, 350.0, len(T)))}
    text = propose_map(Log(Path("log.csv"), signals))
    assert 'psi_rad = "Kurs * deg"' in text
    assert "CHECK: a heading, or a course over ground" in text
    signals["Steuerkurs"] = Signal(T, np.linspace(1.0, 351.0, len(T)))
    text = propose_map(Log(Path("log.csv"), signals))
    assert 'psi_rad = "Steuerkurs * deg"' in text
    assert "CHECK" not in text


GERMAN = ("Zeit", "Breite", "Länge", "Kurs [°]", "Drehzahl Bb [U/min]", "Drehzahl Stb [U/min]")
FRENCH = ("temps", "latitude", "longitude", "cap [°]", "régime bâbord [tr/min]")
FRENCH = (*FRENCH, "régime tribord [tr/min]")
SPANISH = ("tiempo", "latitud", "longitud", "rumbo [°]", "revoluciones babor [rpm]")
SPANISH = (*SPANISH, "revoluciones estribor [rpm]")
NORWEGIAN = ("tid", "breddegrad", "lengdegrad", "kurs [°]", "turtall babord [omdr/min]")
NORWEGIAN = (*NORWEGIAN, "turtall styrbord [omdr/min]")
DUTCH = ("tijd", "breedtegraad", "lengtegraad", "koers [graden]", "toerental bakboord [rpm]")
DUTCH = (*DUTCH, "toerental stuurboord [rpm]")


@pytest.mark.parametrize("names", [GERMAN, FRENCH, SPANISH, NORWEGIAN, DUTCH])
@pytest.mark.parametrize("encoding", ["utf-8", "latin-1", "utf-16", "cp850", "mac_roman", "twice"])
def test_a_foreign_log_becomes_a_recording_in_every_encoding(tmp_path, names, encoding):
    cells = [[text.replace(".", ",") for text in column] for column in columns_of_run().values()]
    rows = [";".join(row) for row in zip(*cells, strict=True)]
    file = tmp_path / "log.csv"
    text = "\n".join([";".join(names), *rows]) + "\n"
    if encoding == "twice":
        file.write_text(text.encode("utf-8").decode("latin-1"), encoding="utf-8")
    else:
        file.write_bytes(text.encode(encoding))
    log = read(file)
    map = propose_map(log, None, DRIVES, DOF, None, lambda: SPEED_AT_80)
    found = convert_log(log, parse_map(tomllib.loads(map), "map.toml"), "map.toml")
    check_motion(found)
    assert "rpm" in map
