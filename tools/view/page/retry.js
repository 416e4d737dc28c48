// How long to wait before the next try to connect.
// SPDX-License-Identifier: Apache-2.0
const kFirstMs = 500, kMostMs = 15000;

/// @param failures  tries in a row that failed, from 0
export const retryDelayMs = (failures) => Math.min(kMostMs, kFirstMs * 2 ** failures);
