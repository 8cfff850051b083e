"""Formatting of numbers, units, evidence and lists for the texts of a report."""

import math
import re
from collections.abc import Iterable, Sequence

from boatsim.recordings.notes import unit_of

DEGREE = 180.0 / math.pi
IN_DEGREES = {"rad": "°", "rad/s": "°/s", "rad/s^2": "°/s²"}
# SI unit -> rows of smallest size, size of the printed unit, its name; the first row that fits
# is used
STEPS = {
    "m": ((1.0, 1.0, "m"), (1e-2, 1e-2, "cm"), (0.0, 1e-3, "mm")),
    "m/s": ((0.1, 1.0, "m/s"), (1e-2, 1e-2, "cm/s"), (0.0, 1e-3, "mm/s")),
    "s": ((0.1, 1.0, "s"), (0.0, 1e-3, "ms")),
    "N": ((1e6, 1e6, "MN"), (1e3, 1e3, "kN"), (1e-2, 1.0, "N"), (0.0, 1e-3, "mN")),
    "N m": ((1e6, 1e6, "MN m"), (1e3, 1e3, "kN m"), (1e-2, 1.0, "N m"), (0.0, 1e-3, "mN m")),
}
FACTOR = "(kg|rad|N|m|s)([2-9]?)"
# the spelling of a unit at the end of a key, such as Ns2pm2
UNIT = re.compile(f"({FACTOR})+(p({FACTOR})+)?|per({FACTOR})+")
NO_ODDS = "–"  # in a table, where the better fit may be chance
OF_CHANCE = " that the better fit is chance"
LONGEST_ODDS = 1e6
# least evidence [nats] and its strength: R. E. Kass, A. E. Raftery, Bayes Factors, J. Am. Stat.
# Assoc. 90, 1995, section 3.2 (Bayes factors of 3, 20 and 150)
STRENGTHS = ((5.0, "very strong"), (3.0, "strong"), (1.1, "positive"), (0.0, "slight"))
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def name_in_words(name: str) -> str:
    """Return a name from a file as words, without underscores: `weak_reverse` -> weak reverse."""
    return name.replace("_", " ")


def join_words(words: Iterable[str], last: str = "and") -> str:
    """Join words to a list in prose: A, B and C."""
    *head, tail = list(words) or [""]
    if not head:
        return tail
    return f"{', '.join(head)} {last} {tail}"


def capitalize(words: str) -> str:
    """Return text with its first letter capitalised, unless it begins with the name of a column."""
    if "_" in words.split(" ", 1)[0]:
        return words
    return words[:1].upper() + words[1:]


def first_sentence(text: str) -> str:
    """Return the first sentence of a text, with its full stop."""
    return f"{text.partition('. ')[0].removesuffix('.')}."


def _decimals(size: float, digits: int) -> int:
    """Return the decimal places that show this many significant digits."""
    if size <= 0.0 or not math.isfinite(size):
        return 0
    return max(0, digits - 1 - math.floor(math.log10(size)))


def format_number(value: float, digits: int = 3) -> str:
    """Format a number with a given count of significant digits.

    Args:
        value: The number; nan is written as "none".
        digits: Number of significant digits.

    Returns:
        The number; it has a power of ten only where plain digits would be hard to read.
    """
    if math.isnan(value):
        return "none"
    if math.isinf(value):
        return "∞"
    size = abs(value)
    value += 0.0  # -0 becomes 0
    if value == 0.0 or 1e-4 <= size < 1e6:
        text = f"{value:.{_decimals(size, digits)}f}"
    else:
        power = math.floor(math.log10(size))
        text = f"{value / 10.0**power:.{digits - 1}f} × {_power_of_ten(power)}"
    return text.replace("-", "−")


def _power_of_ten(power: int) -> str:
    return f"10{str(power).translate(SUPERSCRIPTS)}"


def format_nats(log_bayes_factor: float) -> str:
    """Format log evidence in nats, to tenths below 100."""
    decimals = 1
    if abs(log_bayes_factor) >= 100.0:
        decimals = 0
    return f"{log_bayes_factor:.{decimals}f}".replace("-", "−").replace("−0.0", "0.0")


def format_odds(log_bayes_factor: float) -> str:
    """Return the odds that the better fit behind evidence of this size is chance.

    Args:
        log_bayes_factor: Evidence [nats].

    Returns:
        Words such as "1 in 55 that the better fit is chance": the Bayes factor is exp(evidence).
        Odds beyond a million are not stated: they would say more of the assumed distribution of
        the errors than of the boat.
    """
    if log_bayes_factor < math.log(2.0):
        return "the better fit may be chance"
    if log_bayes_factor < math.log(LONGEST_ODDS):
        odds = float(f"{math.exp(log_bayes_factor):.1e}")
        return f"1 in {odds:,.0f}{OF_CHANCE}"
    return f"less than 1 in a million{OF_CHANCE}"


def evidence_strength(log_bayes_factor: float) -> str:
    """Return the strength of evidence in a word: slight, positive, strong or very strong.

    Args:
        log_bayes_factor: Evidence [nats]; "no" where it is negative.
    """
    for least, word in STRENGTHS:
        if log_bayes_factor >= least:
            return word
    return "no"


def format_evidence(log_bayes_factor: float) -> str:
    """Format evidence in words, with the odds that the better fit is chance.

    Args:
        log_bayes_factor: Evidence [nats].

    Returns:
        Words such as "strong evidence (1 in 55 that the better fit is chance)".
    """
    return f"{evidence_strength(log_bayes_factor)} evidence ({format_odds(log_bayes_factor)})"


def short_odds(log_bayes_factor: float) -> str:
    """Return the odds that the better fit is chance for a table: 1 in 55, "-" if it may be.

    Args:
        log_bayes_factor: Evidence [nats].
    """
    if log_bayes_factor < math.log(2.0):
        return NO_ODDS
    return format_odds(log_bayes_factor).removesuffix(OF_CHANCE)


def format_with_sd(value: float, sd: float) -> str:
    """Format a value ± standard deviation with as many digits as the deviation allows.

    For example, 0.694 ± 0.012.
    """
    if not (math.isfinite(value) and math.isfinite(sd) and sd > 0.0):
        return format_number(value)
    largest = max(abs(value), sd)
    power = 0
    if not 1e-3 <= largest < 1e5:
        power = math.floor(math.log10(largest))
    value /= 10.0**power
    sd /= 10.0**power
    places = min(_decimals(sd, 2), 6)
    text = f"{value:.{places}f} ± {sd:.{places}f}".replace("-", "−")
    if power:
        return f"({text}) × {_power_of_ten(power)}"
    return text


def sentence_in_per_cent(template: str, value: float, sd: float, inactive: float) -> str:
    """Return the sentence on a fitted ratio in per cent that its effect declares.

    For example, astern thrust is 69 % (± 1.5) of the commanded thrust.

    Args:
        template: Sentence with placeholders, see `Param.in_per_cent`; "" for none.
        value: Fitted value.
        sd: Its standard deviation.
        inactive: Value without influence, from which a change is counted.
    """
    if not template:
        return ""
    share = _per_cent(value, sd)
    change = _per_cent(abs(value - inactive), sd)
    more, less, size = "more", "less", "larger"
    if value < inactive:
        more, less, size = "less", "more", "smaller"
    return template.format(
        share=share, more=f"{change} {more}", larger=f"{change} {size}", opposite=less
    )


def _per_cent(share: float, sd: float) -> str:
    """Return a share in per cent with its standard deviation: 69 % (± 1.5)."""
    if not (math.isfinite(sd) and sd > 0.0):
        return f"{format_number(100.0 * share)} %"
    value = f"{100.0 * share:.{_decimals(100.0 * sd, 1)}f}".replace("-", "−")
    return f"{value} % (± {100.0 * sd:.{_decimals(100.0 * sd, 2)}f})"


def format_unit(unit: str) -> str:
    """Format a unit of measurement for print: N s^2/m^2 -> N s²/m²."""
    for digit in "234":
        unit = unit.replace(f"^{digit}", digit.translate(SUPERSCRIPTS))
    return unit


def format_quantity(
    value: float, unit: str, sd: float = 0.0, digits: int = 3, largest: float = 0.0
) -> str:
    """Format a quantity with its standard deviation in a convenient unit.

    Args:
        value: The value [unit].
        unit: Its SI unit; angles are printed in degrees.
        sd: Standard deviation [unit]; 0 where there is none.
        digits: Significant digits without a standard deviation.
        largest: Size of the largest number that is printed next to it in the same unit [unit].

    Returns:
        Text such as 4.34 ± 0.78 cm.
    """
    name, factor = convenient_unit(unit, _largest((value, sd, largest)))
    if sd > 0.0:
        text = format_with_sd(value * factor, sd * factor)
    else:
        text = format_number(value * factor, digits)
    if not name.startswith("°"):
        return f"{text} {name}".rstrip()
    if "×" not in text:
        text = text.replace(" ± ", f"{name} ± ")
    return f"{text}{name}"


def _largest(values: Sequence[float]) -> float:
    """Return the largest size among the finite values, 0 if there is none."""
    return max(map(abs, filter(math.isfinite, values)), default=0.0)


def format_parameter(key: str, value: float, unit: str = "", sd: float = 0.0) -> tuple[str, str]:
    """Format the name and the value ± standard deviation of a fitted parameter for the report.

    Fractions are in per cent.

    Args:
        key: Key of the parameter in diagnosis.json.
        value: Its value [unit].
        unit: Its SI unit; "" if the key has it.
        sd: Its standard deviation [unit].

    Returns:
        Name in words, and the value in a convenient unit; a bearing lies within 0 to 360°.
    """
    name, unit = name_and_unit(key, unit)
    if name.endswith("fraction") and not unit:
        return _fraction(name), f"{format_with_sd(100.0 * value, 100.0 * sd)} %"
    if name == "toward" and unit == "rad":
        value %= 2.0 * math.pi
    if name == "frequency" and unit == "rad/s" and value > 0.0:  # of a wave, not of a rotation
        period = format_number(2.0 * math.pi / value)
        return name, f"{format_with_sd(value, sd)} rad/s, a period of {period} s"
    return name, format_quantity(value, unit, sd)


def format_upper_limit(key: str, value: float) -> tuple[str, str]:
    """Format the name and the upper limit of a parameter: 3.9 mm/s; factors and fractions in %."""
    name, unit = name_and_unit(key)
    if not unit and name.endswith(("factor", "fraction")):
        return _fraction(name), f"{format_number(100.0 * value, 2)} %"
    return name, format_quantity(value, unit, digits=2)


def _fraction(name: str) -> str:
    return name.removesuffix("fraction").strip() or name


def format_sentence(words: str) -> str:
    """Return a sentence of diagnosis.json as the report prints it.

    It has degree signs, and not the p-value at its end.
    """
    words = re.sub(
        r"([\d.]+) rad(?![/\w])", lambda found: f"{float(found[1]) * DEGREE:.2g}°", words
    )
    return re.sub(r"(\d) deg\b", r"\1°", re.sub(r"; p [<=] \S+$", "", words))


def name_and_unit(key: str, unit: str = "") -> tuple[str, str]:
    """Split the key of a parameter in diagnosis.json into its name in words and its unit.

    For example, `toward_rad` becomes (toward, rad).
    """
    compact = unit.replace("1/", "per").replace("/", "p").replace("^", "").replace(" ", "")
    if compact and key.endswith(f"_{compact}"):
        return name_in_words(key.removesuffix(f"_{compact}")), unit
    if unit:
        return name_in_words(key), unit
    name, _, ending = key.rpartition("_")
    unit = unit_of(key)
    if not unit and name and UNIT.fullmatch(ending):
        unit = _unit_from_key(ending)
    if not unit:
        return name_in_words(key), ""
    return name_in_words(name), unit


def _unit_from_key(compact: str) -> str:
    """Return a unit from its spelling in a key: Ns2pm2 -> N s^2/m^2."""
    if compact.startswith("per"):
        return f"1/{_unit_from_key(compact.removeprefix('per'))}"
    above, _, below = compact.partition("p")
    return "/".join(filter(None, map(_product, (above, below))))


def _product(compact: str) -> str:
    symbols = []
    for symbol, power in re.findall(FACTOR, compact):
        symbols.append(f"{symbol}^{power}".removesuffix("^"))
    return " ".join(symbols)


def format_probability(share: float) -> str:
    """Format a probability in per cent; never as 0 or 100 %."""
    if share > 0.999:
        return "> 99.9 %"
    if share < 0.001:
        return "< 0.1 %"
    if 0.01 < share < 0.99:
        return f"{100 * share:.0f} %"
    return f"{100 * share:.1f} %"


def format_cause_probability(probability: float) -> str:
    """Return words for the probability that an identified effect is a true cause.

    Args:
        probability: Between 0 and 1.
    """
    return f"probability {format_probability(probability)} that it is a true cause"


def convenient_unit(unit: str, largest: float) -> tuple[str, float]:
    """Return a convenient unit for numbers up to a given size, and the factor to it.

    For example, N becomes kN with the factor 1e-3.

    Args:
        unit: SI unit.
        largest: Size of the largest number to be printed [unit].

    Returns:
        Name of the printed unit, and the factor to it.
    """
    if unit in IN_DEGREES:
        return IN_DEGREES[unit], DEGREE
    if largest > 0.0:
        for least, size, name in STEPS.get(unit, ()):
            if largest >= least:
                return name, 1.0 / size
    return format_unit(unit), 1.0


def format_in_one_unit(values: Sequence[float], unit: str) -> list[str]:
    """Format several values of one SI unit, all in the same convenient unit."""
    name, factor = convenient_unit(unit, _largest(values))
    if not name.startswith("°"):
        name = f" {name}"
    texts = []
    for value in values:
        texts.append(f"{format_number(value * factor)}{name}")
    return texts
