"""A page complete in itself: its template, with the style, the script and the sections that all our pages share."""

from base64 import b64encode
from hashlib import sha256
from pathlib import Path

TEMPLATES = Path(__file__).parent / "templates"


def rendered(template: Path, **values: object) -> str:
    """The page of a template, which may include any that lies in `TEMPLATES`; the browser fetches nothing."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    script, style = (
        (TEMPLATES / name).read_text(encoding="utf-8") for name in ("report.js", "style.css")
    )
    folders = FileSystemLoader([template.parent, TEMPLATES])
    environment = Environment(
        loader=folders,
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["held"] = _held
    shared = {"script": script, "style": style, "policy": _policy(script)}
    return environment.get_template(template.name).render(**shared, **values)


def _policy(script: str) -> str:
    """What a browser may do with the page: run this script and no other, fetch nothing."""
    own = b64encode(sha256(script.encode()).digest()).decode()
    return f"default-src 'none'; script-src 'sha256-{own}'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"


def _held(words: str) -> str:
    """No line ends within a value."""
    return words.replace(" ± ", "\u00a0±\u00a0").replace(" %", "\u00a0%")
