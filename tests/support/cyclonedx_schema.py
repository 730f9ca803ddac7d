"""The JSON schema of CycloneDX 1.5, which npm's @cyclonedx/cyclonedx-library contains. Needs python3-jsonschema."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema

from npm_packages import install_npm_packages

SCHEMAS = "node_modules/@cyclonedx/cyclonedx-library/res/schema"


class CycloneDx:
    """Reads the schemas, which npm installs in `work`; raises npm_packages.Skipped if it cannot."""

    def __init__(self, work: Path) -> None:
        install_npm_packages(Path(__file__).resolve().parent / "cyclonedx", work)
        folder = work / SCHEMAS
        schema = json.loads((folder / "bom-1.5.SNAPSHOT.schema.json").read_text(encoding="utf-8"))
        base = schema["$id"].rsplit("/", 1)[0]
        store = {f"{base}/{path.name}": json.loads(path.read_text(encoding="utf-8")) for path in folder.glob("*.schema.json")}
        self.validator = jsonschema.Draft7Validator(
            schema, resolver=jsonschema.RefResolver(schema["$id"], schema, store=store))

    def problems(self, bill: object) -> list[str]:
        """Returns what the schema does not accept, each with its place in the document."""
        return [f"{error.json_path}: {error.message}" for error in self.validator.iter_errors(bill)]
