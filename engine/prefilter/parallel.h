// Work in numbered pieces on several threads. What a piece is does not depend on how many threads there are, so neither does any result.
#pragma once
#include <functional>

namespace burnish::prefilter {

/// Calls piece(0) to piece(count - 1) from up to `threads` threads (at least 1, the caller's among them) and returns when all are done. A piece writes only what is its own.
void forEachPiece(int count, int threads, const std::function<void(int piece)>& piece);

/// 0: as many as the machine has cores.
int threadsFor(int wanted);

/// CPU time of the whole process so far, ms.
double cpuMilliseconds();

}  // namespace burnish::prefilter
