#!/usr/bin/env python3
"""No way to pass a value to an object converts it silently.

    typed_values_test.py SOURCE_DIR GENERATED_DIR [--gcc-every N] [--clang-every N] [WAY [KIND]]      GENERATED_DIR has a folder for each device

Each row of WAYS is a statement that passes a value, and each row of KINDS is a wrong value for an object. None of them
compiles as a statement: the compiler rejects the value, or it has a result that must be used. The message has at most 12
lines, with the compilers of Debian 13 at most 18, and the name of the object. A value that is right compiles.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.compilers import CLANG, GCC, SKIPPED, Compiler, in_parallel, precompiled, those_installed  # noqa: E402
from support.messages import MOST_LINES, messages_of_cases  # noqa: E402

UNUSED_IS_FINE = ("-Wno-unused-variable", "-Wno-unused-but-set-variable", "-Wno-unused-parameter")
COMMON_HEADERS = """#include <canopen/sdo/remote_node.hpp>
#include <canopen/node.hpp>
#include <canopen/node/mailbox.hpp>
#include <canopen/node/locked.hpp>
#include <canopen/node/mailbox.hpp>
#include <canopen/master.hpp>
#include <canopen_plant/plant.hpp>
#include <every_type/device.hpp>
#include "support/omitting.hpp"
namespace od = every_type::od;
using Device = every_type::Device;
struct Bus {
  bool send(const canopen::Frame&) { return true; }
  std::optional<canopen::Frame> receive(canopen::Duration);
  canopen::TimePoint now();
};
struct Lock {
  void lock() {}
  void unlock() {}
};
/// A network whose master sends one signal to an object of a node.
template <class Object>
struct NetworkOf {
  struct Tpdo : canopen::Tpdo<Object> {
    static constexpr std::uint16_t number = 1;
    static constexpr auto parameters = canopen::PdoParameters{.cob_id = 0x201};
  };
  struct Rpdo : canopen::Rpdo<Object> {
    static constexpr std::uint16_t number = 1;
    static constexpr auto parameters = canopen::PdoParameters{.cob_id = 0x201};
  };
  struct Signal : canopen::SentSignal<0, Tpdo, 0, Rpdo, 0> {};
  using Master = Device;
  static constexpr canopen::NodeId master_id{std::uint8_t{127}};
  static constexpr canopen::NmtStartUp start_up{};
  static constexpr std::array<canopen::PlantNode, 1> nodes{{{"axis", canopen::NodeId{std::uint8_t{1}}}}};
  static constexpr std::array<canopen::NmtSlave, 1> slaves{{{canopen::NodeId{std::uint8_t{1}}, 0x5}}};
  using Received = canopen::SignalList<>;
  using Sent = canopen::SignalList<Signal>;
  template <class Plant>
  struct Nodes {
    explicit Nodes(Plant&) {}
  };
};
enum Setting : std::uint16_t { setting = 7 };
enum class Mode : std::uint16_t { on = 7 };
using Node = bench::NodeOf<Device, Bus>;
"""
CASE = """namespace case_{number} {{
void pass(Node& node, canopen::Locked<Node, Lock>& locked, canopen::Mailbox<{object}>& box,
          canopen::RemoteNode<Device, Bus>& remote,
          canopen::BlockingObjects<Device, canopen::BlockingSdo<Bus>>& objects,
          canopen::MasterRemote<Device, Bus>& slave, canopen::Plant<NetworkOf<{object}>, Bus>& plant,
          canopen::TimePoint now, canopen::Frame& frame, Bus& bus) {{
  {declaration}
  {statement}
}}
}}
"""


@dataclass(frozen=True)
class Kind:
    name: str
    object: str
    declaration: str
    value: str


LIMITED, PLAIN, TEXT, REAL = ("od::unsigned16_value", "od::access_rw", "od::visible_string_value", "od::real32_value")
NUMBERS = (
    Kind("wider variable", PLAIN, "std::uint32_t value = 65636;", "value"),
    Kind("wider constant variable", PLAIN, "const std::uint32_t value = frame.id;", "value"),
    Kind("wider constant", PLAIN, "", "70000"),
    Kind("signed variable", PLAIN, "std::int16_t value = -1;", "value"),
    Kind("negative constant", PLAIN, "", "-1"),
    Kind("variable with a fraction", PLAIN, "double value = 24.9;", "value"),
    Kind("constant with a fraction", PLAIN, "", "24.9"),
    Kind("constant above the limit", LIMITED, "", "0xFFFF"),
    Kind("enumerator", PLAIN, "", "setting"),
    Kind("enumerator of a class", PLAIN, "", "Mode::on"),
    Kind("bool", PLAIN, "", "true"),
    Kind("text", PLAIN, "", '"a"'),
    Kind("NaN", REAL, "", "std::numeric_limits<double>::quiet_NaN()"),
    Kind("beyond a REAL32", REAL, "", "1e300"),
)
CHECKED = (Kind("limited variable", LIMITED, "std::uint16_t value = frame.size;", "value"),
           Kind("variable of 24 bits", "od::unsigned24_value", "std::uint32_t value = frame.id;", "value"),
           Kind("NaN in a variable", REAL, "float value = std::numeric_limits<float>::quiet_NaN();", "value"))
TEXTS = (Kind("long literal", TEXT, "", '"longer"'), Kind("text of unknown length", TEXT, "std::string_view value;", "value"),
         Kind("number for a text", TEXT, "", "5"))

# The name, the statement, and the kinds of values that it can be given.
NODE, CODEC = (*NUMBERS, *CHECKED, *TEXTS), (*NUMBERS, *CHECKED)
WAYS = {
    "node, tag": ("node.set({object}{{}}, {value});", NODE),
    "node, template": ("node.set<{object}>({value});", NODE),
    "locked, tag": ("locked.set({object}{{}}, {value});", NODE),
    "locked, template": ("locked.set<{object}>({value});", NODE),
    "mailbox, tag": ("box.post({object}{{}}, {value});", NODE),
    "mailbox, template": ("box.post<{object}>({value});", NODE),
    "remote node": ("remote.write<{object}>({value}, now);", (*NUMBERS, *CHECKED)),
    "blocking, tag": ("objects.write({object}{{}}, {value});", NODE),
    "blocking, template": ("objects.write<{object}>({value});", NODE),
    "slave, tag": ("slave.write({object}{{}}, {value});", NODE),
    "slave, template": ("slave.write<{object}>({value});", NODE),
    "slave, later": ("slave.write({object}{{}}, {value}, [](canopen::Result<void>) {{}});", NODE),
    "plant": ("plant.set(NetworkOf<{object}>::Signal{{}}, {value});", (*NUMBERS, *CHECKED)),
    "handler result": ("auto handler = canopen::on_read({object}{{}}, [=] {{ return {value}; }}); "
                       "bench::NodeOf<Device, Bus, decltype(handler)> other{{bus, canopen::NodeId{{std::uint8_t{{5}}}}, handler}};", NUMBERS),
    "PDO, pack": ("(void)canopen::PdoLayout<{object}>::pack({value});", CODEC),
    "PDO, set": ("canopen::PdoLayout<{object}>::set<0>(frame, {value});", CODEC),
    "PDO, set an object": ("canopen::PdoLayout<{object}>::set<{object}>(frame, {value});", CODEC),
    "PDO, pack into": ("canopen::PdoLayout<{object}>::pack_into(frame, {value});", CODEC),
    "PDO, put": ("canopen::PdoLayout<{object}>::put<0>(frame, {value});", CODEC),
}
# What compiles: a value of the type, of a narrower one, and a constant.
RIGHT = (Kind("type", PLAIN, "std::uint16_t value = 5;", "value"), Kind("narrower", PLAIN, "std::uint8_t value = 5;", "value"),
         Kind("constant", PLAIN, "", "5"), Kind("limited constant", LIMITED, "", "0xFFFE"),
         Kind("real constant", REAL, "", "0.5"))
# The same where nothing is refused at run time.
RIGHT_OF_CODECS = (*RIGHT, Kind("checked", LIMITED,
                                f"const auto value = canopen::CheckedValue<{LIMITED}>::from(frame.size);", "*value"))
RIGHT_BY_TYPE = ("handler result",)  # a lambda returns a type: a constant is an int


@dataclass(frozen=True)
class Unit:
    """Cells that are compiled as one file."""
    compiler: Compiler
    cells: tuple[tuple[str, Kind], ...]  # a way and a kind
    is_right: bool

    def name(self, cell: tuple[str, Kind]) -> str:
        return f"{self.compiler.name}: {cell[0]}, {'right ' if self.is_right else ''}{cell[1].name}"

    def text(self, number: int) -> str:
        way, kind = self.cells[number]
        statement = WAYS[way][0].format(object=kind.object, value=kind.value)
        if self.is_right and "(void)" not in statement and not statement.startswith("auto "):
            statement = f"(void){statement}"
        return CASE.format(number=number, object=kind.object, declaration=kind.declaration, statement=statement)


def units_of(compiler: Compiler, only: list[str]) -> list[Unit]:
    """A variable and a constant of one type are in different units: both can be an error of the same specialization."""
    units, right = [], []
    for way, (_, kinds) in WAYS.items():
        if only and way != only[0]:
            continue
        chosen = [kind for kind in kinds if len(only) < 2 or kind.name == only[1]]
        for is_variable in (True, False):
            cells = tuple((way, kind) for kind in chosen if (kind.declaration != "") == is_variable)
            units += [Unit(compiler, cells, False)] if cells else []
        right += [(way, kind) for kind in (RIGHT_OF_CODECS if kinds is CODEC else RIGHT) if len(only) < 2 or kind.name == only[1]
                  if kind.declaration or way not in RIGHT_BY_TYPE]
    return units + ([Unit(compiler, tuple(right), True)] if right else [])


def problem_of(unit: Unit, kind: Kind, lines: list[str]) -> str:
    """Returns the problem of a cell with the messages of the compiler; empty if it has none."""
    if unit.is_right:
        return "does not compile" if lines else ""
    if not lines:
        return "compiles"
    if len(lines) > MOST_LINES:
        return f"{len(lines)} lines"
    return "" if kind.object.split("::")[-1] in "\n".join(lines) else "does not name the object"


def run_unit(job: tuple[Unit, Path, tuple[Path, ...], tuple[str, ...]]) -> list[str]:
    """Returns the problems of the cells."""
    unit, folder, include, flags = job
    cases = [(unit.name(cell), unit.text(number)) for number, cell in enumerate(unit.cells)]
    messages = messages_of_cases(unit.compiler, cases, folder, include, flags)
    problems = [(unit.name(cell), problem_of(unit, cell[1], messages[unit.name(cell)])) for cell in unit.cells]
    problems.append(("", "messages of no case" if messages[""] else ""))
    return ["\n".join((f"{name}: {problem}", *messages[name])) for name, problem in problems if problem]


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("source_dir", type=Path)
    parser.add_argument("generated", type=Path)
    parser.add_argument("--gcc-every", type=int, default=1, metavar="N", help="g++ compiles each Nth part of the table")
    parser.add_argument("--clang-every", type=int, default=1, metavar="N", help="Clang compiles each Nth part of the table")
    parser.add_argument("cell", nargs="*", help="a way, and a kind")
    arguments = parser.parse_args()
    source_dir, generated = arguments.source_dir.resolve(), arguments.generated.resolve()
    compilers = those_installed((GCC, CLANG))
    include = (*(path for path in sorted(generated.iterdir()) if path.is_dir()), generated,
               source_dir / "runtime/include", source_dir / "tests")
    with tempfile.TemporaryDirectory() as scratch:
        jobs = []
        for compiler in compilers:
            folder = Path(scratch) / compiler.name
            folder.mkdir()
            flags = (*UNUSED_IS_FINE, *precompiled(compiler, COMMON_HEADERS, include, folder, UNUSED_IS_FINE))
            every = arguments.clang_every if compiler is CLANG else arguments.gcc_every
            jobs += [(unit, folder / f"unit_{number}", include, flags)
                     for number, unit in enumerate(units_of(compiler, arguments.cell)) if number % every == 0]
        problems = [problem for found in in_parallel(run_unit, jobs) for problem in found]
    for problem in problems:
        print(problem)
    cells = sum(len(unit.cells) for unit, *_ in jobs)
    print(f"{cells} cells, {len(problems)} problems, {len(compilers)} compilers")
    if not compilers:
        return SKIPPED
    return 1 if problems or not jobs else 0


if __name__ == "__main__":
    sys.exit(main())
