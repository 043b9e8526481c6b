/* Runs a command and spoils one of its file-system calls.
 *
 *     faults FOLDER ACTION FROM TO LOG COMMAND [ARGUMENT]...
 *
 * Calls that name a path in FOLDER, or a file that is open there, are numbered from 1. Those from FROM to TO (0: to
 * the end) meet with ACTION:
 *
 *     EIO, ENOSPC, ...   the call is not made and gives this error
 *     short              a read or write is made with half its length
 *     torn               the same, and the process is killed at the next call
 *     kill               the process is killed before the call
 *
 * Every call is written to LOG as "number name path", those that were spoilt with an asterisk in front. The exit
 * status is that of the command; 99 says that the system does not let us watch it.
 *
 * A filter in the kernel stops the command at these calls alone, however they are made: Rust's standard library goes
 * through libc, other crates do not. */
#define _GNU_SOURCE
#include <elf.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

#define NOT_ALLOWED 99

/* Where a call has its file: FD in the first argument, PATH in the first, AT: folder in the first and path in the
 * second. Of two files the first counts. */
enum where { FD, PATH, AT };

static const struct call {
    long number;
    const char *name;
    enum where where;
    int length; /* Which argument is the length of a read or write. */
} calls[] = {
#ifdef SYS_open
    { SYS_open, "open", PATH, 0 },
    { SYS_creat, "creat", PATH, 0 },
    { SYS_stat, "stat", PATH, 0 },
    { SYS_lstat, "lstat", PATH, 0 },
    { SYS_access, "access", PATH, 0 },
    { SYS_mkdir, "mkdir", PATH, 0 },
    { SYS_rmdir, "rmdir", PATH, 0 },
    { SYS_unlink, "unlink", PATH, 0 },
    { SYS_rename, "rename", PATH, 0 },
    { SYS_link, "link", PATH, 0 },
    { SYS_readlink, "readlink", PATH, 0 },
    { SYS_chmod, "chmod", PATH, 0 },
#endif
#ifdef SYS_newfstatat
    { SYS_newfstatat, "newfstatat", AT, 0 },
#endif
#ifdef SYS_renameat
    { SYS_renameat, "renameat", AT, 0 },
#endif
#ifdef SYS_sendfile
    { SYS_sendfile, "sendfile", FD, 0 },
#endif
    { SYS_openat, "openat", AT, 0 },
    { SYS_statx, "statx", AT, 0 },
    { SYS_faccessat, "faccessat", AT, 0 },
    { SYS_mkdirat, "mkdirat", AT, 0 },
    { SYS_unlinkat, "unlinkat", AT, 0 },
    { SYS_renameat2, "renameat2", AT, 0 },
    { SYS_linkat, "linkat", AT, 0 },
    { SYS_readlinkat, "readlinkat", AT, 0 },
    { SYS_fchmodat, "fchmodat", AT, 0 },
    { SYS_truncate, "truncate", PATH, 0 },
    { SYS_statfs, "statfs", PATH, 0 },
    { SYS_read, "read", FD, 2 },
    { SYS_pread64, "pread64", FD, 2 },
    { SYS_readv, "readv", FD, 0 },
    { SYS_write, "write", FD, 2 },
    { SYS_pwrite64, "pwrite64", FD, 2 },
    { SYS_writev, "writev", FD, 0 },
    { SYS_fsync, "fsync", FD, 0 },
    { SYS_fdatasync, "fdatasync", FD, 0 },
    { SYS_ftruncate, "ftruncate", FD, 0 },
    { SYS_fallocate, "fallocate", FD, 0 },
    { SYS_fstat, "fstat", FD, 0 },
    { SYS_fstatfs, "fstatfs", FD, 0 },
    { SYS_fchmod, "fchmod", FD, 0 },
    { SYS_flock, "flock", FD, 0 },
    { SYS_getdents64, "getdents64", FD, 0 },
    { SYS_copy_file_range, "copy_file_range", FD, 0 },
    { SYS_splice, "splice", FD, 0 },
    { SYS_close, "close", FD, 0 },
};
enum { CALLS = sizeof calls / sizeof *calls };

static const struct { const char *name; int number; } errors[] = {
    { "EIO", EIO }, { "ENOSPC", ENOSPC }, { "EACCES", EACCES }, { "EINTR", EINTR }, { "EROFS", EROFS },
    { "EDQUOT", EDQUOT }, { "EMFILE", EMFILE }, { "ENOENT", ENOENT },
};

/* The registers of a stopped thread. */
#if defined(__x86_64__)
#define ARCH AUDIT_ARCH_X86_64
typedef struct user_regs_struct registers;
static long number_of(const registers *r) { return r->orig_rax; }
static unsigned long argument(const registers *r, int k) {
    return k == 0 ? r->rdi : k == 1 ? r->rsi : r->rdx;
}
static void set_length(registers *r, unsigned long length) { r->rdx = length; }
static int refuse(pid_t thread, registers *r, int error) {
    struct iovec all = { r, sizeof *r };
    r->orig_rax = -1;
    r->rax = -error;
    return ptrace(PTRACE_SETREGSET, thread, NT_PRSTATUS, &all);
}
#elif defined(__aarch64__)
#define ARCH AUDIT_ARCH_AARCH64
typedef struct user_regs_struct registers;
static long number_of(const registers *r) { return r->regs[8]; }
static unsigned long argument(const registers *r, int k) { return r->regs[k]; }
static void set_length(registers *r, unsigned long length) { r->regs[2] = length; }
static int refuse(pid_t thread, registers *r, int error) {
    int none = -1;
    struct iovec number = { &none, sizeof none }, all = { r, sizeof *r };
    r->regs[0] = -error;
    return ptrace(PTRACE_SETREGSET, thread, NT_ARM_SYSTEM_CALL, &number)
        || ptrace(PTRACE_SETREGSET, thread, NT_PRSTATUS, &all);
}
#else
#error "no registers are known for this processor"
#endif

static void stop_at_calls(void) {
    struct sock_filter filter[CALLS * 2 + 4], *next = filter;
    *next++ = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr));
    for (int k = 0; k < CALLS; k++) {
        *next++ = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, calls[k].number, 0, 1);
        *next++ = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRACE);
    }
    *next++ = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    struct sock_fprog program = { (unsigned short)(next - filter), filter };
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) || prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program))
        _exit(NOT_ALLOWED);
}

/* A folder and a path in it. */
enum { LONGEST = 2 * PATH_MAX };

static void path_of_fd(pid_t thread, int fd, char *path) {
    char link[64];
    snprintf(link, sizeof link, fd == AT_FDCWD ? "/proc/%d/cwd" : "/proc/%d/fd/%d", thread, fd);
    ssize_t length = readlink(link, path, PATH_MAX - 1);
    path[length < 0 ? 0 : length] = 0;
}

/* A text of the command, byte by byte up to a page: its end is not known, and what follows may not be ours. */
static void text_at(pid_t thread, unsigned long address, char *text) {
    size_t length = 0;
    while (length < PATH_MAX - 1) {
        size_t most = 4096 - (address + length) % 4096;
        if (most > PATH_MAX - 1 - length)
            most = PATH_MAX - 1 - length;
        struct iovec here = { text + length, most }, there = { (void *)(address + length), most };
        ssize_t got = process_vm_readv(thread, &here, 1, &there, 1, 0);
        if (got <= 0)
            break;
        char *end = memchr(text + length, 0, got);
        if (end)
            return;
        length += got;
    }
    text[length] = 0;
}

static void path_of(pid_t thread, const struct call *call, const registers *r, char *path) {
    static char name[PATH_MAX];
    if (call->where == FD) {
        path_of_fd(thread, argument(r, 0), path);
        return;
    }
    text_at(thread, argument(r, call->where == AT), name);
    if (name[0] == '/') {
        strcpy(path, name);
        return;
    }
    path_of_fd(thread, call->where == AT ? (int)argument(r, 0) : AT_FDCWD, path);
    size_t length = strlen(path);
    if (name[0])
        snprintf(path + length, LONGEST - length, "/%s", name);
}

static const char *folder, *action;
static long from, to, counted;
static int torn;
static FILE *calls_log;

/* What becomes of a call at which a thread has been stopped. */
static void meet(pid_t thread, pid_t process) {
    registers r;
    static char path[LONGEST];
    struct iovec all = { &r, sizeof r };
    if (ptrace(PTRACE_GETREGSET, thread, NT_PRSTATUS, &all))
        return;
    const struct call *call = calls;
    while (call < calls + CALLS && call->number != number_of(&r))
        call++;
    if (call == calls + CALLS)
        return;
    path_of(thread, call, &r, path);
    size_t length = strlen(folder);
    if (strncmp(path, folder, length) || (path[length] && path[length] != '/'))
        return;
    struct stat file;
    if (call->number == SYS_close) {
        /* A folder is closed without a word, and Rust counts on that. */
        char link[64];
        snprintf(link, sizeof link, "/proc/%d/fd/%d", thread, (int)argument(&r, 0));
        if (stat(link, &file) || S_ISDIR(file.st_mode))
            return;
    }
    counted++;
    int ours = counted >= from && (to == 0 || counted <= to) && from > 0;
    const char *shown = path[length] ? path + length + 1 : ".";
    if (torn) {
        kill(process, SIGKILL);
        return;
    }
    if (!ours) {
        fprintf(calls_log, "%ld %s %s\n", counted, call->name, shown);
        return;
    }
    fprintf(calls_log, "*%ld %s %s\n", counted, call->name, shown);
    if (!strcmp(action, "kill")) {
        kill(process, SIGKILL);
    } else if (!strcmp(action, "short") || !strcmp(action, "torn")) {
        unsigned long bytes = call->length ? argument(&r, call->length) : 0;
        torn = !strcmp(action, "torn");
        if (bytes > 1) {
            set_length(&r, bytes / 2);
            ptrace(PTRACE_SETREGSET, thread, NT_PRSTATUS, &all);
        }
    } else {
        for (size_t k = 0; k < sizeof errors / sizeof *errors; k++)
            if (!strcmp(action, errors[k].name))
                refuse(thread, &r, errors[k].number);
    }
}

int main(int count, char **arguments) {
    if (count < 7)
        return 2;
    folder = arguments[1];
    action = arguments[2];
    from = atol(arguments[3]);
    to = atol(arguments[4]);
    calls_log = fopen(arguments[5], "we");
    if (!calls_log)
        return 2;
    pid_t process = fork();
    if (process == 0) {
        if (ptrace(PTRACE_TRACEME, 0, 0, 0))
            _exit(NOT_ALLOWED);
        raise(SIGSTOP);
        stop_at_calls();
        execvp(arguments[6], arguments + 6);
        _exit(127);
    }
    int status, last = NOT_ALLOWED << 8;
    if (waitpid(process, &status, 0) != process || !WIFSTOPPED(status))
        return NOT_ALLOWED;
    long options = PTRACE_O_TRACESECCOMP | PTRACE_O_TRACECLONE | PTRACE_O_TRACEFORK | PTRACE_O_TRACEVFORK
        | PTRACE_O_TRACEEXEC | PTRACE_O_EXITKILL;
    if (ptrace(PTRACE_SETOPTIONS, process, 0, options))
        return NOT_ALLOWED;
    ptrace(PTRACE_CONT, process, 0, 0);
    for (pid_t thread; (thread = waitpid(-1, &status, __WALL)) > 0;) {
        if (!WIFSTOPPED(status)) {
            if (thread == process)
                last = status;
            continue;
        }
        int event = status >> 16, signal = WSTOPSIG(status);
        if (event == PTRACE_EVENT_SECCOMP)
            meet(thread, process);
        /* Threads begin with a stop; nobody else sends one. */
        int passed = event || signal == SIGSTOP || signal == SIGTRAP ? 0 : signal;
        ptrace(PTRACE_CONT, thread, 0, passed);
    }
    fclose(calls_log);
    if (WIFSIGNALED(last)) {
        signal(WTERMSIG(last), SIG_DFL);
        raise(WTERMSIG(last));
    }
    return WEXITSTATUS(last);
}
