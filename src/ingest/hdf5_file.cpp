// SPDX-License-Identifier: Apache-2.0
#include "ingest/hdf5_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <type_traits>
#include <utility>

#include "core/descriptor.h"

#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

namespace umbrick {
namespace {

// libhdf5 keeps data of its own at the beginning.
struct OpenedFile {
  H5FD_t head{};
  Descriptor file;
  haddr_t end = 0;   // of the file
  haddr_t used = 0;  // end of what libhdf5 takes for its part
  std::pair<dev_t, ino_t> identity;
};
static_assert(std::is_standard_layout_v<OpenedFile>);  // a pointer to it is one to its head

OpenedFile& of(H5FD_t* file) { return *reinterpret_cast<OpenedFile*>(file); }
const OpenedFile& of(const H5FD_t* file) { return *reinterpret_cast<const OpenedFile*>(file); }

H5FD_t* openFile(const char* name, unsigned flags, hid_t, haddr_t) {
  if ((flags & H5F_ACC_RDWR) != 0) return nullptr;
  auto opened = std::make_unique<OpenedFile>();
  opened->file = Descriptor(open(name, O_RDONLY | O_CLOEXEC));
  struct stat found {};
  if (!opened->file || fstat(opened->file.number(), &found) != 0) return nullptr;
  opened->end = static_cast<haddr_t>(found.st_size);
  opened->identity = {found.st_dev, found.st_ino};
  return &opened.release()->head;
}

herr_t closeFile(H5FD_t* file) {
  delete &of(file);
  return 0;
}

int compareFiles(const H5FD_t* a, const H5FD_t* b) {
  return of(a).identity == of(b).identity ? 0 : of(a).identity < of(b).identity ? -1 : 1;
}

// Small reads of voxels are collected, those of headers are not.
herr_t tellFeatures(const H5FD_t*, unsigned long* flags) {
  if (flags) *flags = H5FD_FEAT_DATA_SIEVE | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t endOfUsed(const H5FD_t* file, H5FD_mem_t) { return of(file).used; }
haddr_t endOfFile(const H5FD_t* file, H5FD_mem_t) { return of(file).end; }
herr_t setEndOfUsed(H5FD_t* file, H5FD_mem_t, haddr_t address) {
  of(file).used = address;
  return 0;
}

// What lies behind the end of the file is 0, as the drivers of libhdf5 have it.
herr_t readBytes(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, std::size_t count, void* out) {
  const OpenedFile& from = of(file);
  const std::size_t there = address >= from.end ? 0 : std::min<haddr_t>(count, from.end - address);
  auto* bytes = static_cast<char*>(out);
  std::memset(bytes + there, 0, count - there);
  for (std::size_t done = 0; done < there;) {
    const ssize_t got = pread(from.file.number(), bytes + done, there - done, static_cast<off_t>(address + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return -1;  // the file has become shorter
    done += static_cast<std::size_t>(got);
  }
  return 0;
}

herr_t writeNothing(H5FD_t*, H5FD_mem_t, hid_t, haddr_t, std::size_t, const void*) { return -1; }

// Who writes the file keeps readers out by a lock. File systems without locks keep out nobody.
herr_t lockFile(H5FD_t* file, hbool_t write) {
  const int done = flock(of(file).file.number(), (write ? LOCK_EX : LOCK_SH) | LOCK_NB);
  return done == 0 || errno != EWOULDBLOCK ? 0 : -1;
}
herr_t unlockFile(H5FD_t* file) {
  flock(of(file).file.number(), LOCK_UN);
  return 0;
}

H5FD_class_t driver() {
  H5FD_class_t our{};
#ifdef H5FD_CLASS_VERSION
  our.version = H5FD_CLASS_VERSION;
  our.value = static_cast<H5FD_class_value_t>(600);  // from 512 on they are free
#endif
  our.name = "umbrick";
  our.maxaddr = (haddr_t(1) << 63) - 1;
  our.fc_degree = H5F_CLOSE_WEAK;
  our.open = openFile;
  our.close = closeFile;
  our.cmp = compareFiles;
  our.query = tellFeatures;
  our.get_eoa = endOfUsed;
  our.set_eoa = setEndOfUsed;
  our.get_eof = endOfFile;
  our.read = readBytes;
  our.write = writeNothing;
  our.lock = lockFile;
  our.unlock = unlockFile;
  return our;
}

}  // namespace

Hdf5Handle openHdf5File(const std::filesystem::path& path) {
  const H5FD_class_t our = driver();
  // The file keeps the driver for as long as it is open.
  const Hdf5Handle registered(H5FDregister(&our), H5FDunregister);
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_driver(access.get(), registered.get(), nullptr);
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose};
}

}  // namespace umbrick
