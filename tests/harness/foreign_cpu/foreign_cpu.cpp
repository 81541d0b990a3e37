// SPDX-License-Identifier: GPL-3.0-or-later
// What the constructor in cpu_check.cpp keeps from running.
int main() {}
