// SPDX-License-Identifier: GPL-3.0-or-later
// The target test_headers, whose precompiled headers all tests share, needs a source.
