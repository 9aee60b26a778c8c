# Toolchain: 64-bit ARM by Debian's cross compiler (g++-aarch64-linux-gnu) against a folder of arm64
# packages, -DOSSA_ARM64_ROOT=FOLDER; programs run by qemu-user-static. tests/arm64/run makes the folder.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES OSSA_ARM64_ROOT)
set(CMAKE_SYSROOT ${OSSA_ARM64_ROOT})
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static -cpu cortex-a72 -L ${OSSA_ARM64_ROOT})

set(CMAKE_FIND_ROOT_PATH ${OSSA_ARM64_ROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${OSSA_ARM64_ROOT})
set(ENV{PKG_CONFIG_LIBDIR} ${OSSA_ARM64_ROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${OSSA_ARM64_ROOT}/usr/share/pkgconfig)

# Where the linker finds what libraries need in turn.
set(library_folder ${OSSA_ARM64_ROOT}/usr/lib/aarch64-linux-gnu)
foreach(kind EXE SHARED MODULE)
  set(CMAKE_${kind}_LINKER_FLAGS_INIT
      "-Wl,-rpath-link,${library_folder}:${library_folder}/blas:${library_folder}/lapack:${OSSA_ARM64_ROOT}/lib/aarch64-linux-gnu")
endforeach()
