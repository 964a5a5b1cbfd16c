! Stands in for a finite-element host with a UMAT: biaxial tests of several points, in which the vertical strain is
! given and the lateral stress stays. Newton's method finds the lateral strain, and calls UMAT point by point as a host
! does. Arguments: a case file, settings parted by commas, points, increments, vertical strain of the last point, and
! `batch` or `single`. Prints what the first and the last point answer at the end.
program umat_host
  use grains_umat
  implicit none
  integer, parameter :: most_iterations = 8
  real(c_double), parameter :: tolerance = 1.0e-3, strain_share = 0.5
  real(c_double), allocatable :: lateral(:), f_before(:, :), f_now(:, :), stress(:, :)
  real(c_double) :: total, vertical, ddsdde(4, 4), pnewdt, off, worst
  integer :: increments, i, k, iteration, iterations, clock(2), rate
  character(len=80) :: word

  call get_command_argument(1, case_file)
  call get_command_argument(2, settings)
  do k = 1, len_trim(settings)
    if (settings(k:k) == ',') settings(k:k) = new_line('a')
  end do
  points = number(3)
  increments = number(4)
  call get_command_argument(5, word)
  read (word, *) total
  call get_command_argument(6, word)
  one_rve_a_batch = word == 'single'
  allocate (lateral(points), f_before(2, points), f_now(2, points), stress(4, points))
  call uexternaldb(0, 0, [0d0, 0d0], 0d0, 1, 0)
  call uexternaldb(1, 0, [0d0, 0d0], 0d0, 1, 0)
  f_before = 1
  do k = 1, points
    f_now(:, k) = 1
    call call_umat(k)
  end do
  lateral = stress(1, :)
  worst = 0
  iterations = 0
  call system_clock(clock(1), rate)
  do i = 1, increments
    call uexternaldb(1, 0, [0d0, 0d0], 1d0, 1, i)
    f_now = f_before
    do k = 1, points
      vertical = total * (strain_share + (1 - strain_share) * k / points)
      f_now(2, k) = 1 - vertical * i / increments
    end do
    do iteration = 1, most_iterations
      off = 0
      do k = 1, points
        pnewdt = 1
        call call_umat(k)
        if (pnewdt < 1) error stop 'a point has no answer: this host cannot cut an increment'
        off = max(off, abs(stress(1, k) - lateral(k)) / abs(lateral(k)))
        f_now(1, k) = f_now(1, k) - f_now(1, k) * (stress(1, k) - lateral(k)) / ddsdde(1, 1)
      end do
      iterations = iterations + 1
      if (off < tolerance) exit
    end do
    ! The last correction of an iterate that was good enough is below the tolerance; UMAT has not seen it.
    call uexternaldb(2, 0, [0d0, 0d0], 1d0, 1, i)
    f_before(2, :) = f_now(2, :)
    do k = 1, points
      f_before(1, k) = f_seen(k)
      if (.not. one_rve_a_batch) stress([1, 2, 4], k) = stress_now(:, k)
      worst = max(worst, abs(stress(1, k) - lateral(k)) / abs(lateral(k)))
    end do
  end do
  call system_clock(clock(2))
  do k = 1, points, max(1, points - 1)
    print '(a, i0, a, 2f14.3, a, es12.4)', 'point ', k, ': stress [Pa]', stress(1:2, k), ', lateral strain', &
      f_before(1, k) - 1
  end do
  print '(a, i0, a, i0, a, es9.2, a, es9.2, a, f8.3, a)', 'increments ', increments, ', iterations ', iterations, &
    ', out of balance ', worst, ', error of the tangents ', largest_error, ', ', real(clock(2) - clock(1)) / rate, ' s'
  call uexternaldb(3, 0, [0d0, 0d0], 0d0, 1, increments)

contains
  integer function number(argument)
    integer, intent(in) :: argument
    character(len=80) :: text
    call get_command_argument(argument, text)
    read (text, *) number
  end function

  ! F_xx that the grains have seen last.
  real(c_double) function f_seen(k)
    integer, intent(in) :: k
    f_seen = f_before(1, k) * (1 + gradient(1, 1, k))
  end function

  subroutine call_umat(k)
    integer, intent(in) :: k
    real(c_double) :: f0(3, 3), f1(3, 3), none(4), matrix(3, 3)
    none = 0
    matrix = 0
    f0 = 0
    f1 = 0
    f0(1, 1) = f_before(1, k); f0(2, 2) = f_before(2, k); f0(3, 3) = 1
    f1(1, 1) = f_now(1, k); f1(2, 2) = f_now(2, k); f1(3, 3) = 1
    call umat(stress(:, k), none, ddsdde, 0d0, 0d0, 0d0, 0d0, none, none, 0d0, none, none, [0d0, 0d0], 1d0, 0d0, 0d0, &
              [0d0], [0d0], repeat('GRAINS', 13) // '  ', 3, 1, 4, 4, none, 4, none(1:3), matrix, pnewdt, 1d0, f0, f1, &
              k, 1, 1, 1, [1, 1, 1, 1], 1)
  end subroutine
end program
