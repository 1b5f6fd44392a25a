# Toolchain for 64-bit ARM: Debian's cross compiler, qemu to run what it makes, and libraries and
# headers from the folder FIIMAP_ARM64_ROOT alone, into which scripts/test_arm unpacks packages.
# Nothing is found in the machine's own /usr/include and /usr/lib.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
# The cross compiler brings the C and C++ libraries in a folder of its own.
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L /usr/aarch64-linux-gnu)

# CMake tries the compiler in a project of its own, which must know the folder too.
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES FIIMAP_ARM64_ROOT)
set(CMAKE_FIND_ROOT_PATH ${FIIMAP_ARM64_ROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
