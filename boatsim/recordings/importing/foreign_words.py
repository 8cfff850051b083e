"""Words of signal names in other European languages, translated to the English words of the rules.

`MEANINGS` is the only table. Its words are written with their letters; a name may have them with
accents, without (`Kraengung`, `Langengrad`), or with letters that a program wrote in another
encoding, which are unknown characters then.
"""

import re
import unicodedata
from collections.abc import Sequence
from functools import lru_cache

# English words -> words of German, French, Spanish, Italian, Portuguese, Dutch, Norwegian, Danish
# and Swedish
MEANINGS = {
    "heading": (
        "steuerkurs kompasskurs kompass compas compás cap kurs kurswinkel koers rumbo rotta "
        "bussola brújula kompas"
    ),
    "course": "route ruta",
    "ground": "grund fond fondo grunn grond fundo",
    "yaw": "gier gieren gierwinkel lacet guiñada imbardata guinada",
    "yaw rate": (
        "drehrate wenderate gierrate wendegeschwindigkeit drehgeschwindigkeit "
        "giergeschwindigkeit svinghastighet svingrate giringsrate draaisnelheid girhastighet"
    ),
    "turn": "virage giro drehung wendung rotation rotación rotazione",
    "rate": "taux tasa tasso",
    "roll": "rollwinkel rollen roulis balanceo rollio rull rulling slingeren",
    "heel": "krängung krängungswinkel gîte escora sbandamento krengning slagzij",
    "pitch": "nickwinkel nicken stampfen tangage cabeceo beccheggio stampen",
    "speed": (
        "geschwindigkeit fahrt vitesse velocidad velocità velocidade snelheid hastighet hastighed "
        "fart"
    ),
    "surge speed": "längsgeschwindigkeit fahrtlängs",
    "sway speed": "quergeschwindigkeit",
    "surge": "längs längsrichtung longitudinale",
    "sway": "quer querrichtung transversale",
    "rudder": (
        "ruder ruderlage ruderblatt barre gouvernail safran timón timone leme roer ror roder"
    ),
    "tiller": "pinne caña barra",
    "angle": "winkel ángulo angolo ângulo hoek vinkel",
    "rudder angle": "ruderwinkel roerhoek rorvinkel rodervinkel rudervinkel",
    "shaft speed": (
        "drehzahl régime toerental turtall varvtal omdrejninger omdreininger revoluciones giri "
        "umdrehungen"
    ),
    "shaft": "welle arbre eje albero aksel",
    "motor": "antrieb maschine moteur motore",
    "propeller": "schraube hélice elica schroef skrue",
    "thrust": "schub schubkraft poussée empuje spinta stuwkracht skyvekraft",
    "throttle": "gashebel fahrhebel gaz acelerador acceleratore gashendel pådrag gaspådrag",
    "azimuth": "schwenkwinkel azimut azimutwinkel",
    "setpoint": "soll sollwert consigne consigna gewenst ønsket",
    "command": "befehl kommando commande comando mando ordre orden pådragsordre",
    "measured": "gemessen istwert mesuré mesurée medido misurato gemeten målt",
    "actual": "ist",
    "latitude": ("breite breitengrad latitud latitudine breddegrad bredde breedtegraad breedte"),
    "longitude": (
        "länge längengrad longitud longitudine lengdegrad lengde lengtegraad lengte længdegrad "
        "længde longitudgrad"
    ),
    "position": "posición posizione positie posisjon posição standort",
    "north": "nord norte noord hochwert",
    "east": "ost este oost øst rechtswert",
    "depth": "tiefe wassertiefe profondeur profundidad profondità dybde diepte djup",
    "wind": "vent viento vento vind",
    "direction": "richtung dirección direzione richting retning riktning",
    "apparent": "scheinbar scheinbarer scheinbare aparente apparente schijnbare tilsynelatende",
    "wind direction": "windrichtung windwinkel vindretning windrichting vindriktning",
    "wind speed": "windgeschwindigkeit windstärke vindstyrke windsnelheid vindhastighet",
    "acceleration": (
        "beschleunigung accélération aceleración accelerazione akselerasjon versnelling"
    ),
    "current": (
        "strömung corriente corrente strøm ström stroming strom stromstärke stroom stroomsterkte "
        "courant"
    ),
    "voltage": "spannung voltaje tensione spenning",
    "battery": "batterie akku batteria batería bateria batteri accu",
    "temperature": "temperatur température temperatura temperatuur",
    "port": (
        "backbord backbords bâbord babor babordo bakboord bagbord babord links linker linke gauche "
        "izquierda izquierdo sinistra sinistro esquerda venstre vänster"
    ),
    "starboard": (
        "steuerbord steuerbords tribord estribor dritta stuurboord styrbord rechts rechter rechte "
        "droite droit derecha derecho destra destro direita høyre højre höger"
    ),
    "bow": "bug proue proa prua boeg baug vorn avant",
    "stern": "heck poupe popa poppa hekk agter akter achtern hinten arrière",
    "time": (
        "zeit uhrzeit zeitstempel messzeit temps horodatage tiempo tid tidspunkt tijd tijdstip "
        "klokkeslett tidsstempel tempo"
    ),
    "date": "datum fecha dato",
    "hour": "stunde heure hora",
    "second": "sekunde sekunden seconde secondes segundos sekunder seconden",
    "value": "wert messwert valeur valor valore waarde verdi värde",
    "unit": "einheit unité unidad unità unidade eenheid enhet enhed",
    "name": "bezeichnung nombre naam navn namn",
    "sensor": "messstelle fühler capteur sensore",
    "quantity": "messgröße grandeur magnitud grandezza grootheid størrelse",
    "deg": "grad degré degrés grado grados gradi graden grader",
    "kn": "knoten nœud nœuds noeuds nudo nudos knop knopen nodi nós",
    "percent": "prozent pourcent procent prosent porcentaje",
}
# Abbreviations, which are no parts of longer words
ABBREVIATIONS = {
    "küg": "course ground",
    "füg": "speed ground",
    "fdw": "speed water",
}
# Units as other languages and encodings write them -> unit in English; the degree sign of one
# encoding is a letter or a lost letter in another
UNITS = {
    **dict.fromkeys(("u/min", "upm", "tr/min", "omdr/min", "o/min", "giri/min"), "rpm"),
    **dict.fromkeys(("toeren/min", "varv/min", "rev/min", "t/min", "min-1", "min^-1"), "rpm"),
    **dict.fromkeys(("grad", "degre", "degres", "grados", "gradi", "graden", "grader"), "deg"),
    **dict.fromkeys(("o", "°", "\ufffd"), "deg"),
    **dict.fromkeys(("grad/s", "degre/s", "degres/s", "grados/s", "gradi/s", "o/s"), "deg/s"),
    **dict.fromkeys(("graden/s", "grader/s", "°/s", "\ufffd/s"), "deg/s"),
    **dict.fromkeys(("grad/min", "degres/min", "°/min", "grados/min", "\ufffd/min"), "deg/min"),
    **dict.fromkeys(("knoten", "noeuds", "nudos", "knop", "knopen", "nodi"), "kn"),
    **dict.fromkeys(("prozent", "procent", "prosent"), "percent"),
}
# Headings in these words may be courses over ground: the languages have one word for both
ALSO_COURSE = set("kurs kurswinkel koers rumbo rotta".split())
# Letters of other alphabets that no accent turns into one of a to z, and their usual spellings
LETTERS = {
    **{"ä": ("a", "ae"), "ö": ("o", "oe"), "ü": ("u", "ue"), "ß": ("ss",)},
    **{"ø": ("o", "oe"), "å": ("a", "aa"), "æ": ("ae", "a"), "œ": ("oe",)},
}
UNKNOWN = "\ufffd"  # character of a name whose letter is not known
SHORT = 4  # letters of a word that may be an abbreviation in an English name
MIN_PART = 3  # letters of a part of a compound word
# Between the parts of a compound word: Fahrtsrichtung, Ruderlagenwinkel
LINKS = ("", "s", "n", "en", "e")
# A longer word that English names have with another meaning, too
CAUTIOUS = {"rotation"}
# Words besides which a short word is that of another language; also units and numbers
NEUTRAL = set(
    "de del la le des du di van der den dem die das und et og av im am zu zum til uber ueber over "
    "sobre el sur au sul nav gps gnss imu wahr vrai vero verdadero sann waar magnetisch magnetique "
    "magnetico rpm boat boot bateau barco barca skip schiff bb sb stb bd tb ps".split()
)
ELECTRICAL = {"voltage", "current", "battery", "temperature", "motor", "propeller"}


def plain_name(name: str) -> str:
    r"""Return a name without accents; letters that were lost are the character U+FFFD.

    A name in UTF-8 that was read as Latin 1 is restored. Control characters and signs of other
    encodings (`L\x84nge`, `L?nge`) between letters are letters that were lost.

    Args:
        name: The name.
    """
    if name.isascii() and "?" not in name:
        return name
    name = unicodedata.normalize("NFC", name)
    for _ in range(2):  # some programs do it twice
        if "Ã" not in name and "Â" not in name:
            break
        try:
            name = name.encode("cp1252").decode("utf-8")
        except UnicodeError:
            try:
                name = name.encode("latin-1").decode("utf-8")
            except UnicodeError:
                break
    plain = []
    for letter in unicodedata.normalize("NFC", name):  # also what was restored
        plain.append(_plain_letter(letter))
    return re.sub(r"(?<=[A-Za-z])\?{1,2}(?=[A-Za-z])|(?<!.)\?(?=[a-z])", UNKNOWN, "".join(plain))


def _plain_letter(letter: str) -> str:
    """A letter without its accent; U+FFFD for a character that stands for a lost letter."""
    if letter.isascii() or letter in "°µ":
        return letter
    low = letter.lower()
    if low in LETTERS:
        plain = LETTERS[low][0]
        return plain if letter == low else plain.upper()
    base = unicodedata.normalize("NFD", letter)[0]
    if base.isascii() and base.isalpha():
        return base
    if letter == UNKNOWN or unicodedata.category(letter) in ("Cc", "Sc", "Po", "Sm", "So", "Ps"):
        return UNKNOWN
    return letter


def _spellings(word: str) -> set[str]:
    """Spellings of a word with the letters a to z."""
    found = {""}
    for letter in word:
        if letter in LETTERS:
            choices: tuple[str, ...] = LETTERS[letter]
        else:
            choices = (_plain_letter(letter),)
        longer = set()
        for begin in found:
            for choice in choices:
                longer.add(begin + choice)
        found = longer
    return found


def _table() -> tuple[dict[str, tuple[str, ...]], dict[str, str]]:
    """Spelling -> English words, and spelling -> the word with its letters."""
    meanings: dict[str, tuple[str, ...]] = {}
    written: dict[str, str] = {}
    for english, words in MEANINGS.items():
        for word in words.split():
            for spelling in _spellings(word):
                meanings.setdefault(spelling, tuple(english.split()))
                written.setdefault(spelling, word)
    return meanings, written


TABLE, WRITTEN = _table()
NEUTRAL |= set(" ".join(MEANINGS).split()) - ELECTRICAL
SHORTENED: dict[str, tuple[str, ...]] = {}
for _word, _english in ABBREVIATIONS.items():
    SHORTENED |= dict.fromkeys(_spellings(_word), tuple(_english.split()))
# English words that are parts of compounds
PARTS = set("motor propeller wind rate ruder servo".split())


def translate_words(words: Sequence[str]) -> list[str]:
    """Return the words of a name, with those of other languages in English.

    A compound is translated if all of its parts are known. A word of four letters or fewer is
    translated only if all other words of the name are known, too, or are units and numbers: `cap`
    is a heading, but not in `battery_cap`.

    Args:
        words: Words in lower case, with the letters a to z and U+FFFD.
    """
    words = _with_whole_abbreviations(words)
    if not any(_is_foreign(word) for word in words):
        return list(words)
    are_all_known = all(_is_foreign(word) or _is_neutral(word) for word in words)
    count = sum(map(_is_foreign, words))
    found: list[str] = []
    for word in words:
        meaning = _meaning(word)
        is_certain = len(word) > SHORT
        if word in CAUTIOUS:
            is_certain, meaning = False, meaning if count > 1 else ()
        if meaning and (is_certain or are_all_known):
            found += meaning
        else:
            found.append(word)
    if "ground" in found and "heading" in found:
        found[found.index("heading")] = "course"
    return found


def _with_whole_abbreviations(words: Sequence[str]) -> list[str]:
    """Words, of which two are one abbreviation if a capital letter has parted it, as in KüG."""
    found: list[str] = []
    for word in words:
        if found and found[-1] + word in SHORTENED:
            found[-1] += word
        else:
            found.append(word)
    return found


def is_also_course(words: Sequence[str]) -> bool:
    """Return whether a name has a word that means a heading or a course over ground.

    Args:
        words: Words of the name in lower case, before the translation.
    """
    return any(WRITTEN.get(word, "") in ALSO_COURSE for word in words)


def english_unit(unit: str) -> str:
    """Return a unit of another language as a word of expressions, "" for another one.

    Args:
        unit: The unit as the log writes it.
    """
    return UNITS.get(plain_name(unit).lower().replace(" ", ""), "")


def _is_foreign(word: str) -> bool:
    return bool(_meaning(word))


def _is_neutral(word: str) -> bool:
    return word in NEUTRAL or word in UNITS or len(word) == 1 or not word.isalpha()


@lru_cache(maxsize=4096)
def _meaning(word: str) -> tuple[str, ...]:
    """The English words of a word or a compound; () if it is not known."""
    if UNKNOWN in word:
        return _meaning_with_lost_letters(word)
    if word in SHORTENED:
        return SHORTENED[word]
    if word in TABLE:
        return TABLE[word]
    return _meaning_of_compound(word)


def _meaning_with_lost_letters(word: str) -> tuple[str, ...]:
    """The English words of the only word of the table with some letters in place of lost ones."""
    form = re.compile(re.sub(f"{UNKNOWN}{{1,2}}", "[^a-z]", word))
    found = set()
    for spelling, written in WRITTEN.items():
        if form.fullmatch(written):
            found.add(TABLE[spelling])
    if len(found) == 1:
        return found.pop()
    return ()


def _meaning_of_compound(word: str) -> tuple[str, ...]:
    """The English words of the parts of a compound, all of which are known; () otherwise."""
    if len(word) < 2 * MIN_PART or not word.isalpha():
        return ()
    for end in range(len(word) - MIN_PART, MIN_PART - 1, -1):
        first = word[:end]
        meaning = TABLE.get(first, (first,) if first in PARTS else ())
        if not meaning:
            continue
        for link in LINKS:
            rest = word[end:]
            if not rest.startswith(link) or len(rest) - len(link) < MIN_PART:
                continue
            rest = rest[len(link) :]
            further = TABLE.get(rest) or ((rest,) if rest in PARTS else _meaning_of_compound(rest))
            if further:
                return (*meaning, *further)
    return ()
