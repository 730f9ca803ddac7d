#!/usr/bin/env python3
"""The program that prints the lists of docs/safety.md reads C++ correctly.

    safety_lists_test.py SOURCE_DIR [unittest arguments]
"""

from __future__ import annotations

import sys
import unittest
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
sys.path.insert(0, str(SOURCE_DIR / "bench/safety"))
import lists  # noqa: E402


class Tokens(unittest.TestCase):
    def test_comments_and_literals_are_not_code(self):
        source = '/// reinterpret_cast<int>\n/* memcpy(a, b) */ f("reinterpret_cast", \'"\', 1\'000); // offsetof\nconst_cast<int*>(p);'
        words = lists.tokens_of(source)
        self.assertEqual([word for word in words if word in (*lists.CASTS, *lists.COPIES)], ["const_cast"])
        self.assertIn("1'000", words)

    def test_a_raw_string_is_an_error(self):
        with self.assertRaises(ValueError):
            lists.tokens_of('auto text = R"(memcpy)";')


class Loops(unittest.TestCase):
    def kinds(self, source: str) -> list[str]:
        return [loop.kind for loop in lists.loops_of("x.hpp", lists.tokens_of(source))]

    def test_ranges(self):
        self.assertEqual(self.kinds("for (const auto& row : rows) f(row);"), ["range"])
        self.assertEqual(self.kinds("for (std::size_t i = 0; auto row : rows) f(i, row);"), ["range"])

    def test_counted(self):
        for header in ("std::size_t i = 0; i < count; ++i", "int i = n; i > 0; --i", "unsigned i = n; i-- > 0;",
                       "std::size_t i = 0; i < rows.size() && good; ++i", "auto* at = first; at != first + 4; ++at",
                       "std::size_t i = 0; i + 1 < size; i += 2"):
            with self.subTest(header):
                self.assertEqual(self.kinds(f"for ({header}) {{ f(i); *at = 3; }}"), ["counted"])

    def test_others(self):
        for loop in ("while (busy()) f();", "do f(); while (--n != 0);", "for (;;) f();", "for (unsigned i = 0; !ready(); ++i) {}",
                     "for (int i = 0; i < n; ++i) { if (x) i = 0; }", "for (int i = 0; i < n; ++i) ++n;",
                     "for (int i = 0; i < n(); ++i) f();", "for (int i = 0; i < n || wait; ++i) f();",
                     "for (int i = 0; i < n; ++j) f();"):
            with self.subTest(loop):
                self.assertEqual(self.kinds(loop), ["other"])

    def test_a_loop_in_a_loop(self):
        self.assertEqual(self.kinds("for (int i = 0; i < n; ++i) for (int j = 0; j < n; ++j) if (a) { f(); } else ++i;"),
                         ["other", "counted"])


class Cycles(unittest.TestCase):
    def test_each_cycle_is_found_once(self):
        calls = {"a": {"b", "c"}, "b": {"a"}, "c": {"c", "d"}, "d": {"b"}}
        self.assertEqual(sorted(lists.elementary_cycles(calls)), [("a", "b"), ("a", "c", "d", "b"), ("c",)])

    def test_names(self):
        self.assertEqual(lists.short_name("void canopen::Node<Device, B>::serve(int) [with Device = x::D]\\nfile:1\\n8 bytes"),
                         "Node::serve")
        self.assertEqual(lists.short_name("constexpr _Res std::__invoke(_Fn&&) [with _Res = void]"), "")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
