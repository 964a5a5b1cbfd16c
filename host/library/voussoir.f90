! The functions of voussoir.h for Fortran. Compile this file with your program and link libvoussoir.so. voussoir.h
! states units, shapes and codes. C has the last index fastest and Fortran the first one, so that the arrays are here
!   gradients(2, 2, n): gradients(j, i, k) = F_ij - delta_ij of RVE k, so F minus identity and not F
!   stress(3, n), tangent(3, 3, n): the tangent is symmetric
! A text for C ends with c_null_char. An array that may be NULL is a pointer: c_loc(array), or c_null_ptr.
module voussoir
  use, intrinsic :: iso_c_binding
  implicit none
  public

  integer(c_int), parameter :: voussoir_ok = 0, voussoir_misuse = 1, voussoir_wrong_input = 2, &
    voussoir_no_equilibrium = 3, voussoir_machine_failure = 4, voussoir_interrupted = 130

  interface
    function voussoir_start(threads) bind(c) result(code)
      import :: c_int, c_int32_t
      integer(c_int32_t), value :: threads
      integer(c_int) :: code
    end function

    function voussoir_stop() bind(c) result(code)
      import :: c_int
      integer(c_int) :: code
    end function

    function voussoir_create(case_file, n, settings, note, context, rves) bind(c) result(code)
      import :: c_int, c_int64_t, c_char, c_ptr, c_funptr
      character(kind=c_char), intent(in) :: case_file(*), settings(*)
      integer(c_int64_t), value :: n
      type(c_funptr), value :: note
      type(c_ptr), value :: context
      type(c_ptr), intent(out) :: rves
      integer(c_int) :: code
    end function

    function voussoir_evaluate(rves, n, gradients, stress, tangent, status) bind(c) result(code)
      import :: c_int, c_int64_t, c_double, c_ptr
      type(c_ptr), value :: rves, tangent, status
      integer(c_int64_t), value :: n
      real(c_double), intent(in) :: gradients(2, 2, *)
      real(c_double), intent(out) :: stress(3, *)
      integer(c_int) :: code
    end function

    function voussoir_committed(rves, n, stress, tangent) bind(c) result(code)
      import :: c_int, c_int64_t, c_double, c_ptr
      type(c_ptr), value :: rves, tangent
      integer(c_int64_t), value :: n
      real(c_double), intent(out) :: stress(3, *)
      integer(c_int) :: code
    end function

    function voussoir_state_size(rves, size) bind(c) result(code)
      import :: c_int, c_int64_t, c_ptr
      type(c_ptr), value :: rves
      integer(c_int64_t), intent(out) :: size
      integer(c_int) :: code
    end function

    function voussoir_get_state(rves, bytes, size) bind(c) result(code)
      import :: c_int, c_int8_t, c_int64_t, c_ptr
      type(c_ptr), value :: rves
      integer(c_int8_t), intent(out) :: bytes(*)
      integer(c_int64_t), value :: size
      integer(c_int) :: code
    end function

    function voussoir_set_state(rves, bytes, size) bind(c) result(code)
      import :: c_int, c_int8_t, c_int64_t, c_ptr
      type(c_ptr), value :: rves
      integer(c_int8_t), intent(in) :: bytes(*)
      integer(c_int64_t), value :: size
      integer(c_int) :: code
    end function

    function voussoir_field_values(rves, name, values, size) bind(c) result(code)
      import :: c_int, c_int64_t, c_double, c_char, c_ptr
      type(c_ptr), value :: rves
      character(kind=c_char), intent(in) :: name(*)
      real(c_double), intent(out) :: values(*)
      integer(c_int64_t), value :: size
      integer(c_int) :: code
    end function

    function voussoir_last_error() bind(c) result(text)
      import :: c_ptr
      type(c_ptr) :: text
    end function
  end interface

  abstract interface
    function call_with_rves(rves) bind(c) result(code)
      import :: c_int, c_ptr
      type(c_ptr), value :: rves
      integer(c_int) :: code
    end function
  end interface
  procedure(call_with_rves), bind(c) :: voussoir_destroy, voussoir_begin_increment, voussoir_commit

contains

  ! The sentence of the last error of this thread.
  function voussoir_error_text() result(text)
    character(len=:), allocatable :: text
    character(kind=c_char), pointer :: letters(:)
    integer :: k
    call c_f_pointer(voussoir_last_error(), letters, [4096])
    text = ''
    do k = 1, 4096
      if (letters(k) == c_null_char) exit
      text = text // letters(k)
    end do
  end function
end module voussoir
