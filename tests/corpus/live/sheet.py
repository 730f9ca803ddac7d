"""What an EDS, DCF or XDD says of a device, read without edsc: a second source for what the device may send.

It knows the lines of CiA 306-1 and the elements of CiA 311 that bring objects, access, limits and values; what does not
matter on the bus is skipped. Values are looked up for a node-ID.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

BITS = {
    0x01: 1, 0x02: 8, 0x03: 16, 0x04: 32, 0x05: 8, 0x06: 16, 0x07: 32, 0x08: 32, 0x10: 24, 0x11: 64, 0x12: 40, 0x13: 48,
    0x14: 56, 0x15: 64, 0x16: 24, 0x18: 40, 0x19: 48, 0x1A: 56, 0x1B: 64,
}
SIGNED = {0x02, 0x03, 0x04, 0x10, 0x12, 0x13, 0x14, 0x15}
FLOATS = {0x08, 0x11}
XML_TYPES = {
    "BOOL": 1, "SINT": 2, "INT": 3, "DINT": 4, "USINT": 5, "BYTE": 5, "UINT": 6, "WORD": 6, "UDINT": 7, "DWORD": 7,
    "REAL": 8, "STRING": 9, "LREAL": 0x11, "LINT": 0x15, "ULINT": 0x1B, "LWORD": 0x1B,
}
VAR = 7
OBJECT = re.compile(r"([0-9a-f]{4})(?:sub([0-9a-f]{1,2})|(value))?", re.IGNORECASE)
NODE_ID = re.compile(r"\$\w*node_?id", re.IGNORECASE)  # also what some tools write in place of $NODEID


@dataclass(frozen=True)
class Entry:
    data_type: int
    access: str
    value: str  # as it is written; of a DCF the ParameterValue where there is one
    low: str = ""
    high: str = ""

    @property
    def bits(self) -> int | None:
        return BITS.get(self.data_type)

    @property
    def readable(self) -> bool:
        return self.access != "wo"

    @property
    def writable(self) -> bool:
        return self.access in ("rw", "rww", "rwr", "wo")


@dataclass
class Sheet:
    entries: dict[tuple[int, int], Entry] = field(default_factory=dict)
    compact_pdos: bool = False  # communication and mapping parameters may be implied
    commissioned: int = 0  # the node-ID that a DCF is for; its values are those of this one

    def has(self, index: int) -> bool:
        return any(key[0] == index for key in self.entries)

    def get(self, index: int, sub_index: int = 0) -> Entry | None:
        return self.entries.get((index, sub_index))

    def number(self, index: int, sub_index: int, node_id: int) -> int | None:
        entry = self.get(index, sub_index)
        return number_in(entry.value, node_id) if entry else None


def number_in(text: str, node_id: int) -> int | None:
    """None: nothing is written there, or not a whole number."""
    total, known = 0, False
    for term in text.split("+"):
        term = term.strip()
        if NODE_ID.fullmatch(term):
            total += node_id
        else:
            number = plain_number(term)
            if number is None:
                return None
            total += number
        known = True
    return total if known else None


def plain_number(text: str) -> int | None:
    sign, digits = (-1, text[1:]) if text.startswith("-") else (1, text)
    if re.fullmatch(r"0x[0-9a-f]+", digits, re.IGNORECASE):
        return sign * int(digits, 16)
    if re.fullmatch(r"0[0-7]+", digits):
        return sign * int(digits, 8)
    return sign * int(digits) if re.fullmatch(r"[0-9]+", digits) else None


def read_sheet(path: Path) -> Sheet:
    data = path.read_bytes()
    if data.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<"):
        return read_xml(data)
    for encoding in ("utf-8-sig", "latin-1"):
        try:
            return read_ini(data.decode(encoding), path.suffix.lower() == ".dcf")
        except UnicodeDecodeError:
            continue
    raise ValueError(path)


# ---- CiA 306-1 ----


def sections_in(text: str) -> dict[str, dict[str, str]]:
    """By name, both in lower case; of what is there twice the first one."""
    sections: dict[str, dict[str, str]] = {}
    current: dict[str, str] = {}
    for line in text.splitlines():
        line = line.strip()
        if line.startswith(";"):
            continue
        if header := re.match(r"\[([^\]]*)\]", line):
            name = header[1].strip().lower()
            current = {} if name in sections else sections.setdefault(name, {})
        elif "=" in line:
            key, _, value = line.partition("=")
            current.setdefault(key.strip().lower(), value.strip())
    return sections


def entry_of(keys: dict[str, str], is_dcf: bool) -> Entry:
    value = keys.get("defaultvalue", "")
    if is_dcf and keys.get("parametervalue"):
        value = keys["parametervalue"]
    access = keys.get("accesstype", "").lower() or "rw"
    return Entry(plain_number(keys.get("datatype", "")) or 0, access, value, keys.get("lowlimit", ""),
                 keys.get("highlimit", ""))


def read_ini(text: str, is_dcf: bool) -> Sheet:
    sections = sections_in(text)
    is_dcf = is_dcf or any(name.startswith("devicecom") for name in sections)
    sheet = Sheet(compact_pdos=bool(plain_number(sections.get("deviceinfo", {}).get("compactpdo", ""))))
    for name in ("devicecomissioning", "devicecommissioning"):
        node_id = plain_number(sections.get(name, {}).get("nodeid", "")) or 0
        if 1 <= node_id <= 127:
            sheet.commissioned = node_id
    for name, keys in sections.items():
        found = OBJECT.fullmatch(name)
        if not found or found[3]:
            continue
        index = int(found[1], 16)
        if found[2]:
            sheet.entries.setdefault((index, int(found[2], 16)), entry_of(keys, is_dcf))
            continue
        compact = plain_number(keys.get("compactsubobj", ""))
        kind = plain_number(keys.get("objecttype", "")) or VAR
        if compact:
            listed = sections.get(f"{found[1].lower()}value", {})
            sheet.entries.setdefault((index, 0), Entry(0x05, "ro", str(compact)))
            for sub in range(1, min(compact, 254) + 1):
                value = {"defaultvalue": listed[str(sub)]} if str(sub) in listed else {}
                sheet.entries.setdefault((index, sub), entry_of(keys | value, is_dcf))
        elif kind == VAR or kind == 2:
            sheet.entries.setdefault((index, 0), entry_of(keys, is_dcf))
    return sheet


# ---- CiA 311 ----


def read_xml(data: bytes) -> Sheet:
    root = ElementTree.fromstring(data)
    parameters = {}
    for element in root.iter():
        element.tag = element.tag.rpartition("}")[2]
        if element.tag == "parameter":
            parameters[element.get("uniqueID")] = element
    sheet = Sheet()
    for thing in root.iter("CANopenObject"):
        index = int(thing.get("index"), 16)
        subs = [child for child in thing if child.tag == "CANopenSubObject"]
        if not subs:
            sheet.entries[(index, 0)] = xml_entry(thing, parameters)
        for child in subs:
            sheet.entries[(index, int(child.get("subIndex"), 16))] = xml_entry(child, parameters)
    return sheet


ACCESS = {"const": "const", "read": "ro", "write": "wo", "readWrite": "rw", "readWriteInput": "rw", "readWriteOutput": "rw",
          "noAccess": "ro"}


def xml_entry(thing, parameters) -> Entry:
    parameter = parameters.get(thing.get("uniqueIDRef"))
    data_type, access, value, low, high = 0, "rw", "", "", ""
    if parameter is not None:
        access = ACCESS.get(parameter.get("access", "read"), "ro")
        for child in parameter:
            data_type = XML_TYPES.get(child.tag, data_type)
            if child.tag in ("defaultValue", "actualValue"):
                value = child.get("value", value)
            if child.tag == "allowedValues":
                for limits in child.iter("range"):
                    low = next((limit.get("value", "") for limit in limits.iter("minValue")), "")
                    high = next((limit.get("value", "") for limit in limits.iter("maxValue")), "")
    if thing.get("dataType"):
        data_type = int(thing.get("dataType"), 16)
    return Entry(data_type, thing.get("accessType", access).lower(),
                 thing.get("actualValue", thing.get("defaultValue", value)), thing.get("lowLimit", low),
                 thing.get("highLimit", high))
