"""Self-contained HTML pages from templates, with the style and the script of all pages."""

from base64 import b64encode
from hashlib import sha256
from pathlib import Path

TEMPLATES = Path(__file__).parent / "templates"


def render_template(template: Path, further_script: str = "", **values: object) -> str:
    """Return a self-contained HTML page from a template; a browser fetches nothing to show it.

    Args:
        template: Jinja template, which may include any template of `TEMPLATES`.
        further_script: A second script, which runs WebAssembly; "" for none.
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
    policy = _policy(script, further_script)
    return page.render(
        script=script, style=style, policy=policy, further_script=further_script, **values
    )


def _policy(script: str, further_script: str) -> str:
    """Return a content security policy that allows these scripts only and no connections."""
    sources = content_source(script)
    if further_script:
        sources = f"{sources} {content_source(further_script)} 'wasm-unsafe-eval'"
    return (
        f"default-src 'none'; script-src {sources}; style-src 'unsafe-inline'; "
        "base-uri 'none'; form-action 'none'"
    )


def content_source(content: str) -> str:
    """Return the source expression of a content security policy for a script or a style.

    Args:
        content: Its text.
    """
    digest = b64encode(sha256(content.encode()).digest()).decode()
    return f"'sha256-{digest}'"


def _nonbreaking(words: str) -> str:
    """Return a text in which no line breaks within a value."""
    return words.replace(" ± ", "\u00a0±\u00a0").replace(" %", "\u00a0%")
