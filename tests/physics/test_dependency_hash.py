"""Files that a file of boatsim imports."""

import ast
from pathlib import Path

import pytest

from boatsim.physics.dependency_hash import PACKAGE, imported_files


def imported_by_syntax_tree(path: Path) -> set[Path]:
    """Files of boatsim that a file imports itself, by its whole syntax tree."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        names = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        if isinstance(node, ast.ImportFrom) and not node.level:
            names = [str(node.module), *(f"{node.module}.{alias.name}" for alias in node.names)]
        for name in names:
            place = PACKAGE.joinpath(*name.split(".")[1:])
            for file in (place.with_suffix(".py"), place / "__init__.py"):
                if name.startswith("boatsim") and file.is_file():
                    found.add(file)
    return found


@pytest.mark.parametrize("name", ["physics/program.py", "diagnosis/pipeline.py", "api.py"])
def test_all_files_are_found_that_the_syntax_trees_of_the_files_import(name: str) -> None:
    found = imported_files(PACKAGE / name)
    assert len(found) > 20
    for file in found:
        assert imported_by_syntax_tree(file) <= found, file


def test_an_import_in_parentheses_or_in_a_function_counts_and_a_line_of_a_text_does_not(
    tmp_path: Path,
) -> None:
    file = tmp_path / "own.py"
    file.write_text(
        '"""Words.\n\nimport the log of boatsim.errors, and then\n"""\n'
        "from boatsim.physics import (\n    noise,\n    terms,\n)\n"
        "def f():\n    import boatsim.files as files\n"
    )
    found = imported_files(file)
    for name in ("physics/noise.py", "physics/terms.py", "files.py"):
        assert PACKAGE / name in found
    bare = tmp_path / "bare.py"
    bare.write_text('"""import boatsim.files, which a text may say."""\n')
    assert imported_files(bare) == {bare}
