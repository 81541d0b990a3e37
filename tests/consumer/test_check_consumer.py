# SPDX-License-Identifier: GPL-3.0-or-later
"""What `make consumer-check` must find fault with."""
import unittest

from check_consumer import Failure, check_symbols, functions_that_return_packs, symbols_of

HEADER = """
/// Pack told_of(int) is no function.
[[gnu::always_inline]] inline Pack dot(const Pack (&a)[3], const Pack (&b)[3]) {
  Pack sum = a[0] * b[0];
struct Batches {
  Lanes evaluate(const Batch& batch, int point, BatchPoint& out) const {
  double sum(const Pack& p) const;
};
"""
ADDRESS = "0000000000000000"


class Packs(unittest.TestCase):
    def test_functions_that_return_them_are_found(self):
        self.assertEqual(functions_that_return_packs(HEADER), {"dot", "evaluate"})

    def test_none_is_defined_elsewhere(self):
        with self.assertRaisesRegex(Failure, "closest gives a Pack by value"):
            functions_that_return_packs("Pack closest(const Pack& x);\n")

    def test_symbols_that_pass_them_by_value_are_faults(self):
        for kind, symbol in (("W", "esfem::dot(double const __vector(8) (&) [3], double const __vector(8) (&) [3])"),
                             ("W", "esfem::Batches::evaluate(esfem::Batch const&, int, esfem::BatchPoint&) const"),
                             ("W", "double __vector(8) esfem::apply<F>(F const&, double __vector(8) const&)"),
                             ("T", "esfem::scale(double __vector(8), double)"),
                             ("T", "esfem::scale(double, double __vector(4))")):
            with self.subTest(symbol), self.assertRaises(Failure):
                check_symbols(f"{ADDRESS} {kind} {symbol}\n", {"dot", "evaluate"})

    def test_references_and_vectors_of_them_are_none(self):
        for kind, symbol in (("T", "esfem::Surface::closest_points(double __vector(8) const (&) [3]) const"),
                             ("T", "esfem::Tree::evaluate(int)"),
                             ("W", "esfem::sum(std::vector<double __vector(8), std::allocator<double __vector(8)>> const&)"),
                             ("W", "esfem::PointData<1> esfem::Space::data<1>(esfem::Batch const&, double __vector(8)*)")):
            with self.subTest(symbol):
                check_symbols(f"{ADDRESS} {kind} {symbol}\n", {"dot", "evaluate"})

    def test_symbols_are_those_that_others_can_call(self):
        listing = ("   Num:    Value          Size Type    Bind   Vis      Ndx Name\n"
                   f"     6: {ADDRESS}   117 FUNC    LOCAL  DEFAULT    9 esfem::own(int)\n"
                   f"     7: {ADDRESS}   117 FUNC    WEAK   DEFAULT    9 esfem::dot(double, double)\n"
                   f"     8: {ADDRESS}     0 NOTYPE  GLOBAL DEFAULT  UND esfem::wanted(int)\n"
                   f"     9: {ADDRESS}    12 FUNC    GLOBAL HIDDEN    20 esfem::scale(double __vector(8), double)\n")
        self.assertEqual(symbols_of(listing), f"{ADDRESS} W esfem::dot(double, double)\n"
                                              f"{ADDRESS} T esfem::scale(double __vector(8), double)\n")


if __name__ == "__main__":
    unittest.main()
