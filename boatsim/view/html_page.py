"""Self-contained HTML pages from templates, with the style and the script of all pages."""

from base64 import b64encode
from hashlib import sha256
from pathlib import Path

TEMPLATES = Path(__file__).parent / "templates"


def render_template(template: Path, **values: object) -> str:
    """Return a self-contained HTML page from a template; a browser fetches nothing to show it.

    Args:
        template: Jinja template, which may include any template of `TEMPLATES`.
        values: Values of the names that the template uses.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    script = (TEMPLATES / "report.js").read_text(encoding="utf-8")
    style = (TEMPLATES / "style.css").read_text(encoding="utf-8")
    environment = Environment(
        loader=FileSystemLoader([template.parent, TEMPLATES]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["nonbreaking"] = _nonbreaking
    page = environment.get_template(template.name)
    return page.render(script=script, style=style, policy=_policy(script), **values)


def _policy(script: str) -> str:
    """Return a content security policy that allows this script only and no connections."""
    digest = b64encode(sha256(script.encode()).digest()).decode()
    return (
        f"default-src 'none'; script-src 'sha256-{digest}'; style-src 'unsafe-inline'; "
        "base-uri 'none'; form-action 'none'"
    )


def _nonbreaking(words: str) -> str:
    """Return a text in which no line breaks within a value."""
    return words.replace(" ± ", "\u00a0±\u00a0").replace(" %", "\u00a0%")
