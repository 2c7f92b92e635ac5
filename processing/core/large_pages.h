// Large pages for large arrays.
#pragma once

namespace haustra {

/// Starts the program anew, as it was started, with an allocator that asks the kernel for pages of
/// 2 MiB where the system leaves that to programs ("madvise" in transparent_hugepage/enabled, as on
/// many servers and in virtual machines): glibc reads its GLIBC_TUNABLES only at start. What walks
/// through gigabytes misses fewer addresses' translations then, and touches fewer fresh pages; a
/// case is prepared in 0.7 of the time (METHODS §19 "Times of a real case"). Costs a start more,
/// 0.06 s.
///
/// Returns where there is nothing to do: it has been done, whoever started the program has set
/// GLIBC_TUNABLES, the system gives such pages to all or to none, or it cannot start the program.
/// To be called before there are threads, locks or half-written files, which would not outlive it.
/// `argv` is main's.
void useLargePages(char** argv);

}  // namespace haustra
